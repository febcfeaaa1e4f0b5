//! The double sphere model: a unit sphere, a second one ξ behind it, then the unified projection by α.
//!
//! r = sin θ/(α d + (1 − α)(ξ + cos θ)), d = √(sin² θ + (ξ + cos θ)²), −1 < ξ < 1, 0 ≤ α ≤ 1
//! (Usenko, Demmel & Cremers 2018, eqs. 40–45; Kalibr's ds-none).
//!
//! The field ends without a fold where r is greatest (α > ½) or infinite: at ξ + cos θ = −w d with w = α/(1 − α) or its
//! inverse, whichever is smaller, that is at cos θ = −ξ (1 − w²) − w √(1 − ξ² (1 − w²)). The paper's bound −w₂ (eq. 43)
//! comes before it for ξ > 0 and, where two directions share a point already, after it for ξ < 0.

use etendue_core::maths::f64::{acos, atan2, sin_cos};

use super::ModelError;
use super::profile::{Edge, Profile};
use crate::model_error::legal;

/// The double sphere model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleSphere {
    xi: f64,
    alpha: f64,
}

impl DoubleSphere {
    /// The camera of ξ and α.
    ///
    /// # Errors
    /// Where ξ is not between −1 and 1 or α not in [0, 1].
    pub fn new(xi: f64, alpha: f64) -> Result<Self, ModelError> {
        legal("xi", xi, xi.abs() < 1.0, "a number between -1 and 1")?;
        legal("alpha", alpha, (0.0..=1.0).contains(&alpha), "a number from 0 to 1")?;
        Ok(Self { xi, alpha })
    }

    /// ξ.
    #[must_use]
    pub fn xi(&self) -> f64 {
        self.xi
    }

    /// α.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// ξ + cos θ, d and the denominator.
    fn parts(&self, sin: f64, cos: f64) -> [f64; 3] {
        let forward = self.xi + cos;
        let d = (sin * sin + forward * forward).sqrt();
        [forward, d, self.alpha * d + (1.0 - self.alpha) * forward]
    }
}

impl Profile for DoubleSphere {
    fn edge(&self) -> Edge {
        let w = self.alpha.min(1.0 - self.alpha) / self.alpha.max(1.0 - self.alpha);
        let rest = 1.0 - w * w;
        let cos = -self.xi * rest - w * (1.0 - self.xi * self.xi * rest).sqrt();
        Edge::end(acos(cos.clamp(-1.0, 1.0)))
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        sin / self.parts(sin, cos)[2]
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let [_, d, below] = self.parts(sin, cos);
        let second = (cos * d * d + self.xi * sin * sin) / d;
        (self.alpha * second + (1.0 - self.alpha) * (1.0 + self.xi * cos)) / (below * below)
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let (s, a) = (radius * radius, self.alpha);
        let under = 1.0 - (2.0 * a - 1.0) * s;
        let forward = (1.0 - a * a * s) / (a * under.sqrt() + (1.0 - a));
        let root = (forward * forward + (1.0 - self.xi * self.xi) * s).sqrt();
        let scale = (forward * self.xi + root) / (forward * forward + s);
        (under >= 0.0).then(|| atan2(scale * radius, scale * forward - self.xi))
    }
}
