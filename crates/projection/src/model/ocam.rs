//! Scaramuzza's omnidirectional model: a point at ρ sees (x, y, −f(ρ)), f(ρ) = a₀ + a₁ ρ + a₂ ρ² + …
//!
//! Scaramuzza, Martinelli & Siegwart 2006 (eq. 5; `cam2world` of the OCamCalib toolbox). The toolbox's first coordinate runs
//! down the rows, its second to the right and its third out of the image towards the camera's back, so that a₀ < 0 for
//! a camera that looks ahead; here they are y, x and −z. ρ is in pixels after the affine map c, d, e is undone, and so are the
//! points of this model: its camera matrix has fx = fy = 1.
//!
//! The inverse is solved numerically, to the last units; the toolbox's inverse polynomial is a fit to it and is not used. The field ends at the first
//! ρ at which θ = atan2(ρ, −f) stops growing.

use etendue_core::maths::f64::atan2;

use super::ModelError;
use super::profile::{AffineProfile, FieldEdge, Profile, Projection};
use crate::plane::Affine;
use crate::rectilinear::{finite_list, legal};
use crate::root::{derivative, first_sign_change, increasing, polynomial};

/// Scaramuzza's model.
#[derive(Clone, Debug, PartialEq)]
pub struct Ocam(AffineProfile<OcamPolynomial>);

impl Ocam {
    /// Creates the camera from a₀, a₁, … (px, …) and the affine map.
    ///
    /// # Errors
    /// If a₀ is not negative, a number is not finite or the map mirrors.
    pub fn new(coefficients: Vec<f64>, affine: Affine) -> Result<Self, ModelError> {
        finite_list("a", 0, &coefficients)?;
        let a0 = coefficients.first().copied().unwrap_or(0.0);
        legal("a0", a0, a0 < 0.0, "a negative number of pixels (a camera that looks along its axis)")?;
        affine.check()?;
        Ok(Self(AffineProfile { profile: OcamPolynomial::new(coefficients), affine }))
    }

    /// a₀, a₁, …
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.0.profile.f
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
struct OcamPolynomial {
    f: Vec<f64>,
    slope: Vec<f64>,
    max_radius_px: f64,
    edge: FieldEdge,
}

/// Larger than any image, px.
const MAX_PX: f64 = 1e6;

impl OcamPolynomial {
    fn new(f: Vec<f64>) -> Self {
        // dθ/dρ has the sign of −f + ρ f′ = Σ (k − 1) aₖ ρᵏ.
        let turn: Vec<f64> = f.iter().enumerate().map(|(k, a)| (k as f64 - 1.0) * a).collect();
        let fold = first_sign_change(&turn, MAX_PX);
        let greatest_px = fold.unwrap_or(MAX_PX);
        let angle_rad = atan2(greatest_px, -polynomial(&f, greatest_px));
        Self {
            slope: derivative(&f),
            f,
            max_radius_px: greatest_px,
            edge: FieldEdge { angle_rad, folds: fold.is_some() },
        }
    }

    /// θ and dθ/dρ.
    fn value(&self, radius: f64) -> [f64; 2] {
        let forward = -polynomial(&self.f, radius);
        let slope = forward + radius * polynomial(&self.slope, radius);
        [atan2(radius, forward), slope / (radius * radius + forward * forward)]
    }
}

impl Profile for OcamPolynomial {
    fn edge(&self) -> FieldEdge {
        self.edge
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let guess = -self.f[0] * angle_rad;
        increasing(angle_rad, [0.0, self.max_radius_px], guess, |r| self.value(r)).unwrap_or(self.max_radius_px)
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        1.0 / self.value(self.radius(angle_rad))[1]
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        (radius < self.max_radius_px).then(|| self.value(radius)[0])
    }
}
