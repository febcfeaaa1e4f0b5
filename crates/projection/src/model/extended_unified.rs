//! The extended unified model: an ellipsoid in place of the sphere.
//!
//! r = sin θ/(α √(β sin² θ + cos² θ) + (1 − α) cos θ), 0 ≤ α ≤ 1, β > 0 (Khomutenko, Garcia & Martinet 2016; Kalibr's
//! eucm-none, COLMAP's EUCM). β = 1 is the unified model with ξ = α/(1 − α) and a focal length of f/(1 − α).
//!
//! The field ends without a fold where cos θ = −w √(β sin² θ + cos² θ), w = α/(1 − α) or its inverse, whichever is smaller.

use etendue_core::maths::f64::{atan2, sin_cos};

use super::ModelError;
use super::profile::{Edge, Profile};
use crate::model_error::legal;

/// The extended unified model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedUnified {
    alpha: f64,
    beta: f64,
}

impl ExtendedUnified {
    /// The camera of α and β.
    ///
    /// # Errors
    /// Where α is not in [0, 1] or β not positive.
    pub fn new(alpha: f64, beta: f64) -> Result<Self, ModelError> {
        legal("alpha", alpha, (0.0..=1.0).contains(&alpha), "a number from 0 to 1")?;
        legal("beta", beta, beta > 0.0, "a positive number")?;
        Ok(Self { alpha, beta })
    }

    /// α.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// β.
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// √(β sin² θ + cos² θ).
    fn distance(&self, sin: f64, cos: f64) -> f64 {
        (self.beta * sin * sin + cos * cos).sqrt()
    }
}

impl Profile for ExtendedUnified {
    fn edge(&self) -> Edge {
        let w = self.alpha.min(1.0 - self.alpha) / self.alpha.max(1.0 - self.alpha);
        Edge::end(atan2((1.0 - w * w).sqrt(), -w * self.beta.sqrt()))
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        sin / (self.alpha * self.distance(sin, cos) + (1.0 - self.alpha) * cos)
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let distance = self.distance(sin, cos);
        let below = self.alpha * distance + (1.0 - self.alpha) * cos;
        ((1.0 - self.alpha) + self.alpha * cos / distance) / (below * below)
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let s = self.beta * radius * radius;
        let under = 1.0 - (2.0 * self.alpha - 1.0) * s;
        let forward = (1.0 - self.alpha * self.alpha * s) / (self.alpha * under.sqrt() + (1.0 - self.alpha));
        (under >= 0.0).then(|| atan2(radius, forward))
    }
}
