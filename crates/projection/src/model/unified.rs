//! The unified omnidirectional model: a unit sphere seen from ξ behind its centre, then a distortion.
//!
//! r = sin θ/(cos θ + ξ), then k₁, k₂, p₁, p₂ (Geyer & Daniilidis 2000; Mei & Rives 2007, `cv::omnidir`, Kalibr's omni-none
//! and omni-radtan). ξ = 0 is the pinhole, 1 the stereographic projection.
//!
//! The field ends, by the formula and without a fold of the calibration, at cos θ = −ξ for ξ ≤ 1 (at infinity) and at
//! cos θ = −1/ξ for ξ > 1 (at r = 1/√(ξ² − 1)). Mirrors are described by ξ and γ; γ is in the camera matrix.

use etendue_core::maths::f64::{acos, atan2, sin_cos};

use super::ModelError;
use super::profile::{Edge, Profile, Projection};
use super::staged::Distorted;
use crate::model_error::legal;
use crate::plane::{Distortion, DistortionTerms};

/// The unified model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unified(Distorted<Sphere>);

impl Unified {
    /// The camera of ξ ≥ 0 and distortion terms; Mei's are `numerator` k₁, k₂ and `tangential` p₁, p₂.
    ///
    /// # Errors
    /// Where ξ is negative or a number is not finite.
    pub fn new(xi: f64, terms: DistortionTerms) -> Result<Self, ModelError> {
        legal("xi", xi, xi >= 0.0, "0 or a positive number")?;
        terms.check()?;
        let profile = Sphere { xi };
        Ok(Self(Distorted { profile, distortion: Distortion::new(terms, profile.reach()) }))
    }

    /// ξ.
    #[must_use]
    pub fn xi(&self) -> f64 {
        self.0.profile.xi
    }

    /// Its distortion.
    #[must_use]
    pub fn distortion(&self) -> &Distortion {
        &self.0.distortion
    }

    pub(super) fn projection(&self) -> &dyn Projection {
        &self.0
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Sphere {
    xi: f64,
}

impl Sphere {
    /// The radius that is not reached.
    fn reach(self) -> f64 {
        if self.xi > 1.0 { 1.0 / (self.xi * self.xi - 1.0).sqrt() } else { 1e8 }
    }
}

impl Profile for Sphere {
    fn edge(&self) -> Edge {
        Edge::end(acos(-self.xi.min(1.0 / self.xi)))
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        sin / (cos + self.xi)
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (_, cos) = sin_cos(angle_rad);
        (1.0 + self.xi * cos) / ((cos + self.xi) * (cos + self.xi))
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let s = radius * radius;
        let under = 1.0 + (1.0 - self.xi * self.xi) * s;
        let scale = (self.xi + under.sqrt()) / (1.0 + s);
        (under >= 0.0).then(|| atan2(scale * radius, scale - self.xi))
    }
}
