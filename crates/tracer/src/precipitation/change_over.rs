//! Distances from a camera up to which particles are modelled one by one.
//!
//! A class of diameter D is modelled if a particle covers `smallest_px` of a pixel's width or more: up to D/(smallest_px · p), p the angle of a
//! pixel. If more than `most` such particles would pass through the visible cone during the exposure, all distances are reduced by one factor.
//! Farther away, and nearer than `clear_m`, no particle of the class is modelled; farther away the class is part of the medium. A particle is present
//! by the distance of its centre at the ray's time, the medium by that of the point: together they are the whole class at every distance.

use core::f64::consts::PI;

use etendue_core::maths::f64::{acos, asin, cos};
use glam::DVec3;

use super::size_law::SizeClass;

/// Minimum distance of a modelled class, m: nearer drops would be on the camera itself.
const MIN_MODEL_DISTANCE_M: f64 = 0.02;

/// Resolution of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraResolution {
    /// Angle of a pixel, rad.
    pub pixel_rad: f64,
    /// Minimum width of a modelled particle, as a fraction of a pixel's width.
    pub min_size_px: f64,
    /// Maximum mean number of particles modelled during an exposure.
    pub max_particles: f64,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Distance from the camera within which there are no particles, m.
    pub clear_m: f64,
}

/// Distance up to which each class is modelled.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangeOver {
    /// Distance within which there are no particles, m.
    pub clear_m: f64,
    /// By class, m; `clear_m` if none is modelled.
    pub radii_m: Vec<f64>,
    /// Mean number of particles in the region at a time.
    pub expected: f64,
}

impl ChangeOver {
    /// The change-over of a camera that sees a region.
    #[must_use]
    pub fn new(classes: &[SizeClass], resolution: &CameraResolution, region: &VisibleRegion) -> Self {
        let clear_m = resolution.clear_m;
        let resolved = |class: &SizeClass| class.diameter_m / (resolution.min_size_px * resolution.pixel_rad);
        let fraction = (region.solid_angle_sr() / (4.0 * PI)).min(1.0);
        let cone = |r: f64| 4.0 / 3.0 * PI * fraction * r * r * r;
        let at_a_moment = |class: &SizeClass, r: f64| class.number_per_m3 * (cone(r) - cone(clear_m));
        // Particles that fall into the ball about the camera during the exposure; all of them may cross the cone.
        let falling =
            |class: &SizeClass, r: f64| class.number_per_m3 * PI * r * r * class.speed_mps * resolution.exposure_s;
        let count = |scale: f64, of: &dyn Fn(&SizeClass, f64) -> f64| -> f64 {
            let reached = classes.iter().map(|class| (class, scale * resolved(class)));
            reached.filter(|(_, r)| *r > clear_m).map(|(class, r)| of(class, r)).sum()
        };
        let fits = |scale: f64| count(scale, &at_a_moment) + count(scale, &falling) <= resolution.max_particles;
        let scale = if fits(1.0) { 1.0 } else { max_scale(fits) };
        let radius = |class: &SizeClass| {
            let radius = scale * resolved(class);
            if radius < MIN_MODEL_DISTANCE_M { clear_m } else { radius.max(clear_m) }
        };
        Self { clear_m, radii_m: classes.iter().map(radius).collect(), expected: count(scale, &at_a_moment) }
    }

    /// Maximum distance, m.
    #[must_use]
    pub fn max_distance_m(&self) -> f64 {
        self.radii_m.iter().copied().fold(0.0, f64::max)
    }
}

/// The maximum scale below 1 that fits, by bisection; 0 if none does.
fn max_scale(fits: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

/// A cone from the origin of a view, or all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleRegion {
    axis: DVec3,
    half_angle_rad: f64,
    margin_m: f64,
}

impl VisibleRegion {
    /// All directions.
    pub const EVERYWHERE: Self = Self { axis: DVec3::X, half_angle_rad: core::f64::consts::PI, margin_m: 0.0 };

    /// The cone about unit `directions`, each with a margin of `room_rad`, whose rays start within `margin_m` of the origin.
    #[must_use]
    pub fn around(directions: &[DVec3], room_rad: f64, margin_m: f64) -> Self {
        let Some(axis) = directions.iter().sum::<DVec3>().try_normalize() else { return Self::EVERYWHERE };
        let minimum = directions.iter().map(|direction| direction.dot(axis)).fold(1.0, f64::min);
        let half_angle_rad = (acos(minimum.clamp(-1.0, 1.0)) + room_rad).min(core::f64::consts::PI);
        Self { axis, half_angle_rad, margin_m }
    }

    #[must_use]
    pub fn solid_angle_sr(&self) -> f64 {
        core::f64::consts::TAU * (1.0 - cos(self.half_angle_rad))
    }

    /// True if a ray along a unit direction, from within the margin, sees only the region.
    pub(super) fn holds(&self, direction: DVec3) -> bool {
        self.half_angle_rad >= core::f64::consts::PI || direction.dot(self.axis) >= cos(self.half_angle_rad)
    }

    /// True if a ball may be visible; false only if it certainly is not.
    pub(super) fn may_see(&self, centre_m: DVec3, radius_m: f64) -> bool {
        let (distance, radius) = (centre_m.length(), radius_m + self.margin_m);
        if distance <= radius || self.half_angle_rad >= core::f64::consts::PI {
            return true;
        }
        let away = acos((centre_m.dot(self.axis) / distance).clamp(-1.0, 1.0));
        away <= self.half_angle_rad + asin(radius / distance)
    }
}
