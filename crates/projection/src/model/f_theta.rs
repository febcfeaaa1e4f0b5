//! F-theta cameras: a polynomial from the field angle to the radius, or from the radius to the field angle.
//!
//! r = c₁ θ + c₂ θ² + … or θ = c₁ r + c₂ r² + …, up to a stated maximum angle, then the affine map c, d, e: the f-theta model of NVIDIA DriveWorks
//! ("angle-to-pixeldistance", "pixeldistance-to-angle"). A polynomial in pixels goes with a camera matrix of fx = fy = 1; one in focal lengths with
//! the camera's own. [`Affine`] stretches the rows by c, in OCamCalib's order; files whose c stretches the columns must be converted to that order.

use core::f64::consts::PI;

use super::ModelError;
use super::profile::{AffineProfile, FieldEdge, Profile, Projection};
use crate::plane::Affine;
use crate::rectilinear::{finite_list, legal};
use crate::root::{derivative, first_sign_change, increasing, polynomial};

/// Argument of an f-theta polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FThetaSense {
    /// The field angle, rad; it gives the radius.
    AngleToRadius,
    /// The radius; it gives the field angle, rad.
    RadiusToAngle,
}

/// The f-theta model.
#[derive(Clone, Debug, PartialEq)]
pub struct FTheta(AffineProfile<FThetaPolynomial>);

impl FTheta {
    /// Creates the camera from c₀ = 0, c₁, c₂, …, up to a field angle.
    ///
    /// # Errors
    /// If c₀ is not 0, c₁ not positive, a number not finite, the angle not in (0, π] or the affine map mirrors.
    pub fn new(
        sense: FThetaSense,
        coefficients: Vec<f64>,
        greatest_angle_rad: f64,
        affine: Affine,
    ) -> Result<Self, ModelError> {
        finite_list("c", 0, &coefficients)?;
        let c = |i: usize| coefficients.get(i).copied().unwrap_or(0.0);
        legal("c0", c(0), c(0) == 0.0, "0: the axis is seen at the principal point")?;
        legal("c1", c(1), c(1) > 0.0, "a positive number")?;
        let inside = greatest_angle_rad > 0.0 && greatest_angle_rad <= PI;
        legal("the greatest angle", greatest_angle_rad.to_degrees(), inside, "above 0° and no more than 180°")?;
        affine.check()?;
        Ok(Self(AffineProfile { profile: FThetaPolynomial::new(sense, coefficients, greatest_angle_rad), affine }))
    }

    /// Direction of the polynomial.
    #[must_use]
    pub fn sense(&self) -> FThetaSense {
        self.0.profile.sense
    }

    /// c₀, c₁, …
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.0.profile.c
    }

    /// The maximum field angle as stated, rad.
    #[must_use]
    pub fn max_angle_rad(&self) -> f64 {
        self.0.profile.stated_rad
    }

    /// The affine map.
    #[must_use]
    pub fn affine(&self) -> Affine {
        self.0.affine
    }

    pub(super) fn projection(&self) -> &dyn Projection {
        &self.0
    }
}

#[derive(Clone, Debug, PartialEq)]
struct FThetaPolynomial {
    sense: FThetaSense,
    c: Vec<f64>,
    slope: Vec<f64>,
    /// The maximum angle as stated.
    stated_rad: f64,
    /// The maximum argument: an angle or a radius.
    max_argument: f64,
    edge: FieldEdge,
}

impl FThetaPolynomial {
    fn new(sense: FThetaSense, c: Vec<f64>, greatest_angle_rad: f64) -> Self {
        let slope = derivative(&c);
        let by_angle = sense == FThetaSense::AngleToRadius;
        let last = if by_angle { greatest_angle_rad } else { radius_reaching(&c, &slope, greatest_angle_rad) };
        let fold = first_sign_change(&slope, last);
        let maximum = fold.unwrap_or(last);
        let angle_rad = if by_angle { maximum } else { polynomial(&c, maximum).min(greatest_angle_rad) };
        Self {
            sense,
            c,
            slope,
            stated_rad: greatest_angle_rad,
            max_argument: maximum,
            edge: FieldEdge { angle_rad, folds: fold.is_some() },
        }
    }

    fn value(&self, x: f64) -> [f64; 2] {
        [polynomial(&self.c, x), polynomial(&self.slope, x)]
    }

    /// The argument of a value; `None` at the maximum or beyond.
    fn inverse(&self, value: f64) -> Option<f64> {
        increasing(value, [0.0, self.max_argument], value / self.c[1], |x| self.value(x))
    }
}

/// The radius at which the angle is reached, or one beyond the turning point of a polynomial that does not reach it.
fn radius_reaching(c: &[f64], slope: &[f64], angle_rad: f64) -> f64 {
    let mut high = angle_rad / c[1];
    while polynomial(c, high) < angle_rad && polynomial(slope, high) > 0.0 {
        high *= 2.0;
    }
    let rising = [0.0, first_sign_change(slope, high).unwrap_or(high)];
    let reached = increasing(angle_rad, rising, angle_rad / c[1], |x| [polynomial(c, x), polynomial(slope, x)]);
    reached.unwrap_or(high)
}

impl Profile for FThetaPolynomial {
    fn edge(&self) -> FieldEdge {
        self.edge
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        match self.sense {
            FThetaSense::AngleToRadius => self.value(angle_rad)[0],
            FThetaSense::RadiusToAngle => self.inverse(angle_rad).unwrap_or(self.max_argument),
        }
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        match self.sense {
            FThetaSense::AngleToRadius => self.value(angle_rad)[1],
            FThetaSense::RadiusToAngle => 1.0 / self.value(self.radius(angle_rad))[1],
        }
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        match self.sense {
            FThetaSense::AngleToRadius => self.inverse(radius),
            FThetaSense::RadiusToAngle => (radius < self.max_argument).then(|| self.value(radius)[0]),
        }
    }
}
