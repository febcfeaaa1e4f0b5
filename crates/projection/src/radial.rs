//! Radial distortion: ideal point ↔ observed point of the sensor plane.
//!
//! r′ = r (1 + k₁ r² + k₂ r⁴) about the principal point, with the direction and the radius unit stated:
//!
//! | | the polynomial takes | and gives | barrel has |
//! | --- | --- | --- | --- |
//! | [`Sense::IdealToObserved`] | the undistorted radius | the distorted radius | k₁ < 0 (OpenCV, with the radius in focal lengths) |
//! | [`Sense::ObservedToIdeal`] | the distorted radius | the undistorted radius | k₁ > 0 (picture filters that fetch) |
//!
//! The other direction is the numerical inverse, so both directions of one model are exact inverses of each other. A
//! polynomial of the other direction that comes near is a [`fit`](RadialDistortion::fitted), with its residual; to first
//! order its k₁ has the opposite sign.
//!
//! Left out: tangential and thin-prism terms, k₃ and up, the rational form.

use crate::polynomial::RadialPolynomial;
use glam::DVec2;

/// Which way the polynomial runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
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
    /// Principal distances: tangents of the field angle (OpenCV). The principal distance is the focal length of a lens
    /// focused at infinity.
    FocalLengths,
    /// Halves of the picture's diagonal.
    HalfDiagonals,
    /// Pixels (square ones).
    Pixels,
}

/// The lengths that the radius units stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusScales {
    /// The principal distance, mm.
    pub principal_distance_mm: f64,
    /// Half the picture's diagonal, mm.
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

/// Why a distortion cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// A coefficient that is not a number, or so large that its radii are none.
    #[error("the distortion coefficients k1 = {k1}, k2 = {k2} must be finite and at most 1e30 in size")]
    Coefficient {
        /// First coefficient.
        k1: f64,
        /// Second coefficient.
        k2: f64,
    },
    /// A radius unit of no length.
    #[error("the distortion's radius unit is {length_mm} mm long; it must be positive and finite")]
    Unit {
        /// Length of the unit, mm.
        length_mm: f64,
    },
    /// The picture reaches beyond the fold.
    #[error(
        "the distortion with k1 = {k1}, k2 = {k2} folds the picture over at an observed radius of {fold_mm:.6} mm, but \
         the picture reaches out to {needed_mm:.6} mm: use coefficients fitted over the whole picture, or crop it"
    )]
    Fold {
        /// First coefficient.
        k1: f64,
        /// Second coefficient.
        k2: f64,
        /// Observed radius of the fold, mm.
        fold_mm: f64,
        /// Largest observed radius asked for, mm.
        needed_mm: f64,
    },
}

/// Largest size of a coefficient, in any unit of radius.
const LARGEST: f64 = 1e30;

/// Radial distortion about the principal point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialDistortion {
    sense: Sense,
    pub(crate) polynomial: RadialPolynomial,
    unit_mm: f64,
}

impl RadialDistortion {
    /// The distortion whose polynomial runs by `sense` over radii in units of `unit_mm` millimetres
    /// ([`RadiusUnit::length_mm`]).
    ///
    /// # Errors
    /// Where a coefficient is not finite or beyond 1e30 (squares of it would overflow), or the unit not a positive length.
    pub fn new(sense: Sense, k1: f64, k2: f64, unit_mm: f64) -> Result<Self, DistortionError> {
        if ![k1, k2].iter().all(|k| k.abs() <= LARGEST) {
            return Err(DistortionError::Coefficient { k1, k2 });
        }
        if !(unit_mm.is_finite() && unit_mm > 0.0) {
            return Err(DistortionError::Unit { length_mm: unit_mm });
        }
        Ok(Self { sense, polynomial: RadialPolynomial::new(k1, k2), unit_mm })
    }

    /// Refuses a distortion that folds inside a picture.
    ///
    /// # Errors
    /// Where the fold's observed radius is not beyond `max_observed_mm`, the largest distance of a point of the picture
    /// from the principal point ([`Raster::max_radius_mm`](crate::Raster::max_radius_mm)).
    pub fn check(&self, max_observed_mm: f64) -> Result<(), DistortionError> {
        let fold_mm = self.fold_observed_mm();
        if fold_mm > max_observed_mm {
            return Ok(());
        }
        let [k1, k2] = self.polynomial.coefficients();
        Err(DistortionError::Fold { k1, k2, fold_mm, needed_mm: max_observed_mm })
    }

    /// Which way the polynomial runs.
    #[must_use]
    pub fn sense(&self) -> Sense {
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

    /// The observed radius of the fold, mm; infinite where there is none.
    #[must_use]
    pub fn fold_observed_mm(&self) -> f64 {
        self.unit_mm
            * match self.sense {
                Sense::IdealToObserved => self.polynomial.fold_value(),
                Sense::ObservedToIdeal => self.polynomial.fold(),
            }
    }

    /// The ideal radius of the fold, mm; infinite where there is none.
    #[must_use]
    pub fn fold_ideal_mm(&self) -> f64 {
        self.unit_mm
            * match self.sense {
                Sense::IdealToObserved => self.polynomial.fold(),
                Sense::ObservedToIdeal => self.polynomial.fold_value(),
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
        self.radius(observed_mm, Sense::ObservedToIdeal)
    }

    /// The observed radius of an ideal one, mm; `None` beyond the fold.
    #[must_use]
    pub fn observed_radius_mm(&self, ideal_mm: f64) -> Option<f64> {
        self.radius(ideal_mm, Sense::IdealToObserved)
    }

    /// How much ideal area one unit of observed area stands for, at an observed radius: (R/r) · dR/dr with R(r) the
    /// ideal radius. 1 on the axis; `None` beyond the fold.
    #[must_use]
    pub fn ideal_area_per_observed(&self, observed_mm: f64) -> Option<f64> {
        let ideal_mm = self.ideal_radius_mm(observed_mm)?;
        if observed_mm == 0.0 {
            return Some(1.0);
        }
        let slope = match self.sense {
            Sense::ObservedToIdeal => self.polynomial.derivative(observed_mm / self.unit_mm),
            Sense::IdealToObserved => 1.0 / self.polynomial.derivative(ideal_mm / self.unit_mm),
        };
        Some(ideal_mm / observed_mm * slope)
    }

    fn radius(&self, r_mm: f64, wanted: Sense) -> Option<f64> {
        let r = r_mm / self.unit_mm;
        let mapped = if wanted == self.sense { self.polynomial.forward(r) } else { self.polynomial.inverse(r) };
        mapped.map(|r| r * self.unit_mm)
    }
}

/// The point on the same ray from the centre with its radius mapped.
fn scaled(point: DVec2, radius: impl Fn(f64) -> Option<f64>) -> Option<DVec2> {
    let r = point.length();
    let mapped = radius(r)?;
    Some(if r > 0.0 { point * (mapped / r) } else { point })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn distortion(sense: Sense, k1: f64, k2: f64, unit_mm: f64) -> RadialDistortion {
        RadialDistortion::new(sense, k1, k2, unit_mm).expect("legal")
    }

    #[test]
    fn barrel_pulls_points_inwards_in_either_direction() {
        // OpenCV's barrel has k1 < 0; the same picture written as a fetching filter has k1 > 0.
        let forward = distortion(Sense::IdealToObserved, -0.1, 0.0, 10.0);
        let fetch = distortion(Sense::ObservedToIdeal, 0.1, 0.0, 10.0);
        for d in [forward, fetch] {
            assert!(d.observed_radius_mm(5.0).expect("inside") < 5.0);
            assert!(d.ideal_radius_mm(5.0).expect("inside") > 5.0);
        }
        // r′ = 0.5 (1 − 0.1 · 0.25) focal lengths.
        assert!((forward.observed_radius_mm(5.0).expect("inside") - 4.875).abs() < 1e-14);
        assert!((fetch.ideal_radius_mm(5.0).expect("inside") - 5.125).abs() < 1e-14);
    }

    #[test]
    fn a_fold_inside_the_picture_is_refused_with_its_radius() {
        let d = distortion(Sense::ObservedToIdeal, -0.2, 0.0, 4.0);
        let fold_mm = 4.0 * (1.0_f64 / 0.6).sqrt();
        assert!(d.check(fold_mm * 0.999).is_ok());
        let refused = d.check(fold_mm * 1.001).expect_err("folds");
        assert!(matches!(refused, DistortionError::Fold { fold_mm: f, .. } if (f - fold_mm).abs() < 1e-12));
        assert!(refused.to_string().contains("5.163978 mm"), "{refused}");
        // The other direction folds at an observed radius that is the polynomial's value.
        let d = distortion(Sense::IdealToObserved, -0.2, 0.0, 4.0);
        assert!((d.fold_observed_mm() - fold_mm * (1.0 - 0.2 / 0.6)).abs() < 1e-12);
        assert!(d.ideal(DVec2::new(d.fold_observed_mm() + 1e-9, 0.0)).is_none());
    }

    #[test]
    fn a_unit_changes_the_numbers_and_not_the_lens() {
        let scales = RadiusScales { principal_distance_mm: 12.0, half_diagonal_mm: 4.0, pixel_pitch_mm: 0.005 };
        let in_mm = distortion(Sense::IdealToObserved, -1e-3, 2e-5, 1.0);
        for unit in [RadiusUnit::Millimetres, RadiusUnit::FocalLengths, RadiusUnit::HalfDiagonals, RadiusUnit::Pixels] {
            let u = unit.length_mm(&scales);
            let d = distortion(Sense::IdealToObserved, -1e-3 * u * u, 2e-5 * u * u * u * u, u);
            let (a, b) = (d.observed_radius_mm(3.0), in_mm.observed_radius_mm(3.0));
            assert!((a.expect("inside") - b.expect("inside")).abs() < 1e-12);
        }
    }

    #[test]
    fn the_area_ratio_is_the_determinant() {
        for sense in [Sense::IdealToObserved, Sense::ObservedToIdeal] {
            let d = distortion(sense, -0.05, 0.02, 8.0);
            let (p, h) = (DVec2::new(2.0, 1.5), 1e-5);
            let at = |q: DVec2| d.ideal(q).expect("inside");
            let dx = (at(p + DVec2::X * h) - at(p - DVec2::X * h)) / (2.0 * h);
            let dy = (at(p + DVec2::Y * h) - at(p - DVec2::Y * h)) / (2.0 * h);
            let ratio = d.ideal_area_per_observed(p.length()).expect("inside");
            // Central differences: h² · third derivative and ε/h, both about 1e-10.
            assert!((dx.perp_dot(dy) - ratio).abs() < 1e-8);
        }
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let nan = RadialDistortion::new(Sense::IdealToObserved, f64::NAN, 0.0, 1.0);
        assert!(matches!(nan, Err(DistortionError::Coefficient { .. })));
        let flat = RadialDistortion::new(Sense::IdealToObserved, 0.0, 0.0, 0.0);
        assert!(matches!(flat, Err(DistortionError::Unit { .. })));
    }

    proptest! {
        #[test]
        fn both_directions_are_inverse(k1 in -0.15..0.15f64, k2 in -0.02..0.02f64, x in -4.0..4.0f64, y in -4.0..4.0f64, forward: bool) {
            let sense = if forward { Sense::IdealToObserved } else { Sense::ObservedToIdeal };
            let d = distortion(sense, k1, k2, 5.0);
            let p = DVec2::new(x, y);
            prop_assume!(p.length() < 0.95 * d.fold_observed_mm());
            let back = d.ideal(p).and_then(|i| d.observed(i)).expect("before the fold");
            // 1e-12 relative, times the root's condition near the fold (at most about 10 at 95 % of it).
            prop_assert!((back - p).length() <= 1e-11 * (p.length() + 1e-3));
        }
    }
}
