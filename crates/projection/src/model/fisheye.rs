//! Polynomial fisheyes, without and with tangential and thin-prism terms.
//!
//! Polynomial fisheye: r = θ (1 + k₁ θ² + k₂ θ⁴ + k₃ θ⁶ + …).
//!
//! Kannala & Brandt 2006 (eq. 6, symmetrical part); with four coefficients `cv::fisheye` and Kalibr's pinhole-equi, with one and two COLMAP's
//! SIMPLE_RADIAL_FISHEYE and RADIAL_FISHEYE, with none the equidistant fisheye. θ counts from the optical axis and extends to 180°, where
//! `cv::fisheye` itself stops at 90°; the field ends at the first angle at which dr/dθ vanishes. The asymmetrical terms of the paper are left out, as
//! in all those programs.
//!
//! Fisheyes with tangential and thin-prism terms: r = θ (1 + k₁ θ² + …) along the azimuth, then a distortion of that plane.
//!
//! | program | polynomial of θ | distortion |
//! | --- | --- | --- |
//! | COLMAP THIN_PRISM_FISHEYE | – | radial k₁ … k₄, p₁, p₂, s₁ (x), s₃ (y) |
//! | COLMAP RAD_TAN_THIN_PRISM_FISHEYE, Aria's Fisheye624 | k₁ … k₆ | p₁, p₂, s₁ … s₄ |

use super::ModelError;
use super::profile::{DistortedProfile, FieldEdge, Profile, Projection};
use crate::plane::{Distortion, DistortionTerms};
use crate::rectilinear::finite_list;
use crate::root::{first_sign_change, increasing};

/// Coefficients of the longest polynomial.
const MAX_COEFFICIENTS: usize = 6;

/// The polynomial fisheye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KannalaBrandt {
    coefficients: [f64; MAX_COEFFICIENTS],
    edge: FieldEdge,
}

impl KannalaBrandt {
    /// Creates the fisheye from these coefficients, k₁ first.
    ///
    /// # Errors
    /// If one is not finite.
    pub fn new(k: [f64; 4]) -> Result<Self, ModelError> {
        Self::long([k[0], k[1], k[2], k[3], 0.0, 0.0])
    }

    /// Creates the fisheye from six coefficients.
    ///
    /// # Errors
    /// If one is not finite.
    pub fn long(coefficients: [f64; MAX_COEFFICIENTS]) -> Result<Self, ModelError> {
        finite_list("k", 1, &coefficients)?;
        let mut slope = [1.0; MAX_COEFFICIENTS + 1];
        for (i, k) in coefficients.iter().enumerate() {
            slope[i + 1] = (2 * i + 3) as f64 * k;
        }
        let sphere = FieldEdge::SPHERE;
        let fold = first_sign_change(&slope, sphere.angle_rad * sphere.angle_rad);
        let edge = fold.map_or(sphere, |square| sphere.nearer(FieldEdge::fold(square.sqrt())));
        Ok(Self { coefficients, edge })
    }

    /// k₁ … k₆.
    #[must_use]
    pub fn coefficients(&self) -> [f64; MAX_COEFFICIENTS] {
        self.coefficients
    }

    /// r and dr/dθ.
    fn value(&self, angle: f64) -> [f64; 2] {
        let s = angle * angle;
        let (mut value, mut slope) = (0.0, 0.0);
        for (i, k) in self.coefficients.iter().enumerate().rev() {
            value = (value + k) * s;
            slope = (slope + (2 * i + 3) as f64 * k) * s;
        }
        [angle * (1.0 + value), 1.0 + slope]
    }
}

impl Profile for KannalaBrandt {
    fn edge(&self) -> FieldEdge {
        self.edge
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        self.value(angle_rad)[0]
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        self.value(angle_rad)[1]
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        increasing(radius, [0.0, self.edge.angle_rad], radius, |angle| self.value(angle))
    }
}

/// A fisheye with tangential and thin-prism terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinPrismFisheye(DistortedProfile<KannalaBrandt>);

impl ThinPrismFisheye {
    /// Creates the fisheye from a polynomial and the distortion terms of its plane.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn new(fisheye: KannalaBrandt, terms: DistortionTerms) -> Result<Self, ModelError> {
        terms.check()?;
        let reach = fisheye.radius(Profile::edge(&fisheye).angle_rad);
        Ok(Self(DistortedProfile { profile: fisheye, distortion: Distortion::new(terms, reach) }))
    }

    /// The polynomial of θ.
    #[must_use]
    pub fn fisheye(&self) -> &KannalaBrandt {
        &self.0.profile
    }

    /// The distortion of the fisheye's plane.
    #[must_use]
    pub fn distortion(&self) -> &Distortion {
        &self.0.distortion
    }

    pub(super) fn projection(&self) -> &dyn Projection {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::FieldEdge;
    use super::*;

    #[test]
    fn the_nearer_of_both_folds_counts() {
        let fisheye = |k1: f64| KannalaBrandt::new([k1, 0.0, 0.0, 0.0]).expect("legal");
        let terms = |k1: f64| DistortionTerms { numerator: [k1, 0.0, 0.0, 0.0], ..DistortionTerms::default() };
        let edge = |a: f64, b: f64| ThinPrismFisheye::new(fisheye(a), terms(b)).expect("legal").projection().edge();
        let fold = (1.0_f64 / 0.3).sqrt();
        // 1 − 0.3 θ² = 0 in either; one unit in the last place of a root and of its inverse.
        assert!((edge(-0.1, 0.0).angle_rad - fold).abs() < 1e-14);
        assert!((edge(0.0, -0.1).angle_rad - fold).abs() < 1e-14 && edge(0.0, -0.1).folds);
        assert_eq!(edge(0.0, 0.0), FieldEdge::SPHERE);
    }
}
