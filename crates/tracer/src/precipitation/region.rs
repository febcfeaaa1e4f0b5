//! What part of space a camera may see.

use etendue_core::maths::f64::{acos, asin, cos};
use glam::DVec3;

/// A cone from the origin of a view, or all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenRegion {
    axis: DVec3,
    half_angle_rad: f64,
    margin_m: f64,
}

impl SeenRegion {
    /// All directions.
    pub const EVERYWHERE: Self = Self { axis: DVec3::X, half_angle_rad: core::f64::consts::PI, margin_m: 0.0 };

    /// The cone about unit `directions`, each with room of `room_rad`, whose rays start within `margin_m` of the origin.
    #[must_use]
    pub fn around(directions: &[DVec3], room_rad: f64, margin_m: f64) -> Self {
        let Some(axis) = directions.iter().sum::<DVec3>().try_normalize() else { return Self::EVERYWHERE };
        let least = directions.iter().map(|direction| direction.dot(axis)).fold(1.0, f64::min);
        let half_angle_rad = (acos(least.clamp(-1.0, 1.0)) + room_rad).min(core::f64::consts::PI);
        Self { axis, half_angle_rad, margin_m }
    }

    /// Solid angle, sr.
    #[must_use]
    pub fn solid_angle_sr(&self) -> f64 {
        core::f64::consts::TAU * (1.0 - cos(self.half_angle_rad))
    }

    /// Whether a ray along a unit direction, from within the margin, sees nothing but the region.
    pub(super) fn holds(&self, direction: DVec3) -> bool {
        self.half_angle_rad >= core::f64::consts::PI || direction.dot(self.axis) >= cos(self.half_angle_rad)
    }

    /// Whether a ball may be seen; certain only where it says no.
    pub(super) fn may_see(&self, centre_m: DVec3, radius_m: f64) -> bool {
        let (distance, radius) = (centre_m.length(), radius_m + self.margin_m);
        if distance <= radius || self.half_angle_rad >= core::f64::consts::PI {
            return true;
        }
        let away = acos((centre_m.dot(self.axis) / distance).clamp(-1.0, 1.0));
        away <= self.half_angle_rad + asin(radius / distance)
    }
}
