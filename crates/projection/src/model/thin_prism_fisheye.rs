//! Fisheyes with tangential and thin-prism terms: r = θ (1 + k₁ θ² + …) along the azimuth, then a distortion of that plane.
//!
//! | program | polynomial of θ | distortion |
//! | --- | --- | --- |
//! | COLMAP THIN_PRISM_FISHEYE | – | radial k₁ … k₄, p₁, p₂, s₁ (x), s₃ (y) |
//! | COLMAP RAD_TAN_THIN_PRISM_FISHEYE, Aria's Fisheye624 | k₁ … k₆ | p₁, p₂, s₁ … s₄ |

use super::ModelError;
use super::kannala_brandt::KannalaBrandt;
use super::profile::{Profile, Projection};
use super::staged::Distorted;
use crate::plane::{Distortion, DistortionTerms};

/// A fisheye with tangential and thin-prism terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinPrismFisheye(Distorted<KannalaBrandt>);

impl ThinPrismFisheye {
    /// The fisheye of a polynomial and the terms of the distortion of its plane.
    ///
    /// # Errors
    /// Where a number is not finite.
    pub fn new(fisheye: KannalaBrandt, terms: DistortionTerms) -> Result<Self, ModelError> {
        terms.check()?;
        let reach = fisheye.radius(Profile::edge(&fisheye).angle_rad);
        Ok(Self(Distorted { profile: fisheye, distortion: Distortion::new(terms, reach) }))
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
    use super::super::Edge;
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
        assert_eq!(edge(0.0, 0.0), Edge::SPHERE);
    }
}
