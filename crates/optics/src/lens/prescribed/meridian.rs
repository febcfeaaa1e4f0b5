//! The frame of one sensor point: its meridian, and rays from it by their tangents.
//!
//! A lens of revolution is the same for all sensor points at one distance from the axis. With s that distance, a ray that
//! leaves the sensor is named by its slopes against the axis: t.x in the meridional plane (away from the axis positive),
//! t.y across it.

use crate::prescription::trace::LensRay;
use glam::{DVec2, DVec3};

/// A sensor point in its meridional frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meridian {
    /// Distance from the axis, mm.
    pub(super) s_mm: f64,
    /// The unit vector from the axis to the point, in the lens frame.
    outward: DVec2,
    sensor_mm: f64,
}

impl Meridian {
    /// Of a point of the erect picture: the light itself falls on its negative.
    pub(super) fn new(point_mm: DVec2, sensor_mm: f64) -> Self {
        let outward = (-point_mm).normalize_or(DVec2::X);
        Self { s_mm: point_mm.length(), outward, sensor_mm }
    }

    /// Of any point at a distance from the axis.
    pub(super) fn at(s_mm: f64, sensor_mm: f64) -> Self {
        Self { s_mm, outward: DVec2::X, sensor_mm }
    }

    /// The ray with slopes `t`, towards the scene.
    #[inline]
    pub(super) fn ray(&self, t: DVec2) -> LensRay {
        let slope = self.outward * t.x + self.outward.perp() * t.y;
        let point = (self.outward * self.s_mm).extend(self.sensor_mm);
        let direction = DVec3::new(slope.x, slope.y, -1.0) / (1.0 + t.length_squared()).sqrt();
        LensRay { point, direction }
    }

    /// How far outwards a point of the lens frame lies.
    pub(super) fn height_mm(&self, point: DVec3) -> f64 {
        point.truncate().dot(self.outward)
    }

    /// cos⁴ of the angle of slopes `t`: projected solid angle by slope area, for ∫ cos θ dω = ∫ cos⁴ θ dt.
    #[inline]
    pub(super) fn cos4(t: DVec2) -> f64 {
        let secant2 = 1.0 + t.length_squared();
        1.0 / (secant2 * secant2)
    }
}
