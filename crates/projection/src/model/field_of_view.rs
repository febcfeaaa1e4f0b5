//! The FOV model: r = atan(2 tan θ tan(ω/2))/ω, 0 < ω < π, below 90°.
//!
//! Devernay & Faugeras 2001 (eqs. 13, 14); COLMAP's FOV, Kalibr's pinhole-fov.

use etendue_core::maths::f64::{atan2, sin_cos, tan};

use super::ModelError;
use super::profile::{Edge, Profile};
use crate::model_error::legal;

/// The FOV model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    omega: f64,
    /// 2 tan(ω/2).
    stretch: f64,
}

impl FieldOfView {
    /// The camera of ω, rad.
    ///
    /// # Errors
    /// Where ω is not between 0 and π.
    pub fn new(omega_rad: f64) -> Result<Self, ModelError> {
        let inside = omega_rad > 0.0 && omega_rad < core::f64::consts::PI;
        legal("omega", omega_rad, inside, "an angle between 0 and 3.14159 rad")?;
        Ok(Self { omega: omega_rad, stretch: 2.0 * tan(0.5 * omega_rad) })
    }

    /// ω, rad.
    #[must_use]
    pub fn omega_rad(&self) -> f64 {
        self.omega
    }
}

impl Profile for FieldOfView {
    fn edge(&self) -> Edge {
        Edge::FRONT
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        atan2(self.stretch * sin, cos) / self.omega
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = sin_cos(angle_rad);
        let across = self.stretch * sin;
        self.stretch / (self.omega * (cos * cos + across * across))
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let turned = radius * self.omega;
        let (sin, cos) = sin_cos(turned);
        (turned < Edge::FRONT.angle_rad).then(|| atan2(sin, self.stretch * cos))
    }
}
