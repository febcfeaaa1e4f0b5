//! A ray that leaves the front.

use etendue_core::ray::PupilRay;
use glam::DVec3;

/// A ray that leaves the front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontRay {
    /// The ray from the last surface that it met, camera frame.
    pub ray: PupilRay,
    /// What a distance along `ray` lacks to the distance that ground truth states, m: see [`FrontRay::truth_origin_m`].
    pub path_m: f64,
    /// Where it met a mirror, camera frame, m.
    pub mirror_m: Option<DVec3>,
}

impl FrontRay {
    /// A ray with nothing in front of the lens.
    #[must_use]
    pub fn bare(ray: PupilRay) -> Self {
        Self { ray, path_m: 0.0, mirror_m: None }
    }

    /// Where the ray table says that the ray begins: at the mirror; else where distances count from.
    #[must_use]
    pub fn truth_origin_m(&self) -> DVec3 {
        self.mirror_m.unwrap_or(self.ray.origin_m - self.ray.direction * self.path_m)
    }
}
