//! Radial distortion: ideal point ↔ observed point of the sensor plane.
//!
//! r′ = r (1 + k₁ r² + k₂ r⁴) about the principal point, with the direction and the radius unit stated:
//!
//! | | the polynomial takes | and gives | barrel has |
//! | --- | --- | --- | --- |
//! | [`DistortionDirection::IdealToObserved`] | the undistorted radius | the distorted radius | k₁ < 0 (OpenCV, with the radius in focal lengths) |
//! | [`DistortionDirection::ObservedToIdeal`] | the distorted radius | the undistorted radius | k₁ > 0 (image filters that map output to input) |
//!
//! The other direction is the numerical inverse, so both directions of one model are exact inverses of each other. A polynomial of the other
//! direction is available as a [`fit`](RadialDistortion::fitted), with its residual; to first order its k₁ has the opposite sign.
//!
//! Left out: tangential and thin-prism terms, k₃ and up, the rational form.
//!
//! One direction of a radial distortion fitted to the other.
//!
//! Programs and papers write distortion in either direction. The inverse of a polynomial is not a polynomial, but can be approximated by one over an
//! image. The fit is least squares of the radius; its maximum error is reported.
//!
//! The even radial polynomial r′ = r (1 + k₁ r² + k₂ r⁴), its inverse, and its fold.
//!
//! The first radius at which dr′/dr = 1 + 3 k₁ r² + 5 k₂ r⁴ vanishes is the fold: beyond it two radii would share one image. Only the branch from 0
//! to the fold is defined; beyond it every function returns `None`. r is dimensionless: the caller chooses its unit ([`RadialDistortion`] states it).

#[cfg(test)]
mod tests;

use glam::DVec2;

use crate::root::increasing;

/// Direction of the polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DistortionDirection {
    /// From the undistorted radius to the distorted one (OpenCV's direction).
    IdealToObserved,
    /// From the distorted radius to the undistorted one.
    ObservedToIdeal,
}

/// The unit in which the polynomial's radius is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadiusUnit {
    /// Millimetres on the sensor.
    Millimetres,
    /// Principal distances: tangents of the field angle (OpenCV). The principal distance is the focal length of a lens focused at infinity.
    FocalLengths,
    /// Half of the image's diagonal.
    HalfDiagonals,
    /// Pixels (square ones).
    Pixels,
}

/// Lengths of the radius units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusScales {
    /// The principal distance, mm.
    pub principal_distance_mm: f64,
    /// Half the image's diagonal, mm.
    pub half_diagonal_mm: f64,
    /// The pixel pitch, mm.
    pub pixel_pitch_mm: f64,
}

impl RadiusUnit {
    /// The unit's length, mm.
    #[must_use]
    pub fn length_mm(self, scales: &RadiusScales) -> f64 {
        match self {
            Self::Millimetres => 1.0,
            Self::FocalLengths => scales.principal_distance_mm,
            Self::HalfDiagonals => scales.half_diagonal_mm,
            Self::Pixels => scales.pixel_pitch_mm,
        }
    }
}

/// Error of a distortion.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// A coefficient that is not a number, or is so large that its radii overflow.
    #[error("the distortion coefficients k1 = {k1}, k2 = {k2} must be finite and at most 1e30 in size")]
    Coefficient {
        /// First coefficient.
        k1: f64,
        /// Second coefficient.
        k2: f64,
    },
    /// A radius unit without a positive length.
    #[error("the distortion's radius unit is {length_mm} mm long; it must be positive and finite")]
    Unit {
        /// Length of the unit, mm.
        length_mm: f64,
    },
    /// A fold inside the image.
    #[error(
        "the distortion with k1 = {k1}, k2 = {k2} folds the image over at an observed radius of {fold_mm:.6} mm, but the image extends to \
         {needed_mm:.6} mm: use coefficients fitted over the whole image, or crop it"
    )]
    Fold {
        /// First coefficient.
        k1: f64,
        /// Second coefficient.
        k2: f64,
        /// Observed radius of the fold, mm.
        fold_mm: f64,
        /// Largest observed radius required, mm.
        needed_mm: f64,
    },
}

/// Largest size of a coefficient, in any unit of radius.
const MAX_COEFFICIENT: f64 = 1e30;

/// Radial distortion about the principal point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialDistortion {
    sense: DistortionDirection,
    pub(crate) polynomial: RadialPolynomial,
    unit_mm: f64,
}

impl RadialDistortion {
    /// Creates the distortion whose polynomial has the direction `sense`, over radii in units of `unit_mm` millimetres ([`RadiusUnit::length_mm`]).
    ///
    /// # Errors
    /// If a coefficient is not finite or beyond 1e30 (its square would overflow), or the unit is not a positive length.
    pub fn new(sense: DistortionDirection, k1: f64, k2: f64, unit_mm: f64) -> Result<Self, DistortionError> {
        if ![k1, k2].iter().all(|k| k.abs() <= MAX_COEFFICIENT) {
            return Err(DistortionError::Coefficient { k1, k2 });
        }
        if !(unit_mm.is_finite() && unit_mm > 0.0) {
            return Err(DistortionError::Unit { length_mm: unit_mm });
        }
        Ok(Self { sense, polynomial: RadialPolynomial::new(k1, k2), unit_mm })
    }

    /// Refuses a distortion that folds inside an image.
    ///
    /// # Errors
    /// If the fold's observed radius is not beyond `max_observed_mm`, the largest distance of a point of the image from the principal point
    /// ([`Raster::max_radius_mm`](crate::Raster::max_radius_mm)).
    pub fn check(&self, max_observed_mm: f64) -> Result<(), DistortionError> {
        let fold_mm = self.fold_observed_mm();
        if fold_mm > max_observed_mm {
            return Ok(());
        }
        let [k1, k2] = self.polynomial.coefficients();
        Err(DistortionError::Fold { k1, k2, fold_mm, needed_mm: max_observed_mm })
    }

    /// Direction of the polynomial.
    #[must_use]
    pub fn sense(&self) -> DistortionDirection {
        self.sense
    }

    /// The coefficients k₁ and k₂, for radii in [`unit_mm`](Self::unit_mm).
    #[must_use]
    pub fn coefficients(&self) -> [f64; 2] {
        self.polynomial.coefficients()
    }

    /// Length of the radius unit, mm.
    #[must_use]
    pub fn unit_mm(&self) -> f64 {
        self.unit_mm
    }

    /// The observed radius of the fold, mm; infinite if there is none.
    #[must_use]
    pub fn fold_observed_mm(&self) -> f64 {
        self.unit_mm
            * match self.sense {
                DistortionDirection::IdealToObserved => self.polynomial.fold_value(),
                DistortionDirection::ObservedToIdeal => self.polynomial.fold(),
            }
    }

    /// The ideal radius of the fold, mm; infinite if there is none.
    #[must_use]
    pub fn fold_ideal_mm(&self) -> f64 {
        self.unit_mm
            * match self.sense {
                DistortionDirection::IdealToObserved => self.polynomial.fold(),
                DistortionDirection::ObservedToIdeal => self.polynomial.fold_value(),
            }
    }

    /// The ideal point of an observed one, mm; `None` beyond the fold.
    #[must_use]
    pub fn ideal(&self, observed_mm: DVec2) -> Option<DVec2> {
        scaled(observed_mm, |r| self.ideal_radius_mm(r))
    }

    /// The observed point of an ideal one, mm; `None` beyond the fold.
    #[must_use]
    pub fn observed(&self, ideal_mm: DVec2) -> Option<DVec2> {
        scaled(ideal_mm, |r| self.observed_radius_mm(r))
    }

    /// The ideal radius of an observed one, mm; `None` beyond the fold.
    #[must_use]
    pub fn ideal_radius_mm(&self, observed_mm: f64) -> Option<f64> {
        self.radius(observed_mm, DistortionDirection::ObservedToIdeal)
    }

    /// The observed radius of an ideal one, mm; `None` beyond the fold.
    #[must_use]
    pub fn observed_radius_mm(&self, ideal_mm: f64) -> Option<f64> {
        self.radius(ideal_mm, DistortionDirection::IdealToObserved)
    }

    /// Ideal area per unit of observed area at an observed radius: (R/r) · dR/dr with R(r) the ideal radius. 1 on the axis; `None` beyond the fold.
    #[must_use]
    pub fn ideal_area_per_observed(&self, observed_mm: f64) -> Option<f64> {
        let ideal_mm = self.ideal_radius_mm(observed_mm)?;
        if observed_mm == 0.0 {
            return Some(1.0);
        }
        let slope = match self.sense {
            DistortionDirection::ObservedToIdeal => self.polynomial.derivative(observed_mm / self.unit_mm),
            DistortionDirection::IdealToObserved => 1.0 / self.polynomial.derivative(ideal_mm / self.unit_mm),
        };
        Some(ideal_mm / observed_mm * slope)
    }

    fn radius(&self, r_mm: f64, direction: DistortionDirection) -> Option<f64> {
        let r = r_mm / self.unit_mm;
        let mapped = if direction == self.sense { self.polynomial.forward(r) } else { self.polynomial.inverse(r) };
        mapped.map(|r| r * self.unit_mm)
    }
}

/// The point on the same ray from the centre with its radius mapped.
fn scaled(point: DVec2, radius: impl Fn(f64) -> Option<f64>) -> Option<DVec2> {
    let r = point.length();
    let mapped = radius(r)?;
    Some(if r > 0.0 { point * (mapped / r) } else { point })
}

/// A distortion fitted to another over an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistortionFit {
    /// The fitted distortion.
    pub distortion: RadialDistortion,
    /// The largest difference of its radius from the other's, mm, over the radii of the fit.
    pub worst_mm: f64,
}

impl RadialDistortion {
    /// Fits the polynomial of direction `sense` and the same radius unit to this distortion, by least squares of the radius over the radii of an
    /// image.
    ///
    /// # Errors
    /// If this distortion folds inside the image, or the fitted one does.
    pub fn fitted(&self, sense: DistortionDirection, max_observed_mm: f64) -> Result<DistortionFit, DistortionError> {
        self.check(max_observed_mm)?;
        let samples = self.pairs(sense, max_observed_mm);
        let [k1, k2] = least_squares(&samples);
        let distortion = Self::new(sense, k1, k2, self.unit_mm())?;
        distortion.check(max_observed_mm)?;
        let worst = samples.iter().map(|[r, out]| (distortion.polynomial_at(*r) - out).abs()).fold(0.0, f64::max);
        Ok(DistortionFit { distortion, worst_mm: worst * self.unit_mm() })
    }

    /// Argument and value, in radius units, of the map of direction `sense` over the radii of an image.
    fn pairs(&self, sense: DistortionDirection, max_observed_mm: f64) -> Vec<[f64; 2]> {
        (1..=FIT_SAMPLES)
            .filter_map(|i| {
                let observed_mm = max_observed_mm * i as f64 / FIT_SAMPLES as f64;
                let ideal = self.ideal_radius_mm(observed_mm)? / self.unit_mm();
                let observed = observed_mm / self.unit_mm();
                Some(if sense == DistortionDirection::ObservedToIdeal { [observed, ideal] } else { [ideal, observed] })
            })
            .collect()
    }

    fn polynomial_at(&self, r: f64) -> f64 {
        self.polynomial.forward(r).unwrap_or(f64::INFINITY)
    }
}

/// Radii at which a fit is evaluated: many more than the turning points of a fifth-degree difference.
const FIT_SAMPLES: usize = 256;

/// k₁, k₂ that minimise Σ (r (1 + k₁ r² + k₂ r⁴) − r′)², by normal equations in the radius scaled to 1 at its end.
fn least_squares(samples: &[[f64; 2]]) -> [f64; 2] {
    let end = samples.iter().map(|[r, _]| *r).fold(0.0, f64::max);
    let (mut a, mut b, mut c, mut p, mut q) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for [r, out] in samples {
        let s = r / end;
        let (cubic, quintic) = (s * s * s, s * s * s * s * s);
        let rest = (out - r) / end;
        a += cubic * cubic;
        b += cubic * quintic;
        c += quintic * quintic;
        p += cubic * rest;
        q += quintic * rest;
    }
    let determinant = a * c - b * b;
    let [k1, k2] = [(p * c - q * b) / determinant, (q * a - p * b) / determinant];
    [k1 / (end * end), k2 / (end * end * end * end)]
}

/// r (1 + k₁ r² + k₂ r⁴) on [0, fold).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialPolynomial {
    k1: f64,
    k2: f64,
    fold: f64,
}

impl RadialPolynomial {
    /// The polynomial with these coefficients.
    #[must_use]
    pub fn new(k1: f64, k2: f64) -> Self {
        Self { k1, k2, fold: fold(k1, k2) }
    }

    /// The coefficients k₁ and k₂.
    #[must_use]
    pub fn coefficients(&self) -> [f64; 2] {
        [self.k1, self.k2]
    }

    /// The first radius with a vanishing derivative; infinite if there is none.
    #[must_use]
    pub fn fold(&self) -> f64 {
        self.fold
    }

    /// The value at the fold: the supremum of [`forward`](Self::forward).
    #[must_use]
    pub fn fold_value(&self) -> f64 {
        if self.fold.is_finite() { self.value(self.fold) } else { f64::INFINITY }
    }

    /// r′ of r ≥ 0; `None` at the fold and beyond.
    #[must_use]
    pub fn forward(&self, r: f64) -> Option<f64> {
        (r < self.fold).then(|| self.value(r))
    }

    /// The derivative dr′/dr.
    #[must_use]
    pub fn derivative(&self, r: f64) -> f64 {
        let s = r * r;
        1.0 + s * (3.0 * self.k1 + s * 5.0 * self.k2)
    }

    /// r of r′ ≥ 0 on the branch before the fold, by Newton's method kept in a bracket, to the last few units in the
    /// last place (looser only where the fold itself makes the root ill-conditioned); `None` beyond the fold's value.
    #[must_use]
    pub fn inverse(&self, value: f64) -> Option<f64> {
        if value.is_nan() || value >= self.fold_value() {
            return None;
        }
        increasing(value, [0.0, self.bracket(value)], value, |r| [self.value(r), self.derivative(r)])
    }

    fn value(&self, r: f64) -> f64 {
        let s = r * r;
        r * (1.0 + s * (self.k1 + s * self.k2))
    }

    /// An upper bound of the root of `value`.
    fn bracket(&self, value: f64) -> f64 {
        let mut high = value.max(f64::MIN_POSITIVE);
        while high < self.fold && self.value(high) <= value {
            high *= 2.0;
        }
        high.min(self.fold)
    }
}

/// The smallest positive root in r of 1 + 3 k₁ r² + 5 k₂ r⁴; infinite if there is none.
fn fold(k1: f64, k2: f64) -> f64 {
    let (a, b) = (5.0 * k2, 3.0 * k1);
    let discriminant = b * b - 4.0 * a;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // Both roots without cancellation: q = −(b + sign(b) √D)/2, s = 1/q and s = q/a (the constant term is 1).
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let roots = [1.0 / q, q / a];
    roots.into_iter().filter(|s| *s > 0.0 && s.is_finite()).fold(f64::INFINITY, f64::min).sqrt()
}
