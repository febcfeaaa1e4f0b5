//! A stored image of a camera in the world.

use crate::camera::stored::StoredRadianceImage;
use core::f64::consts::FRAC_PI_2;
use etendue_core::maths::f64::asin;
use etendue_core::quantity::Length;
use etendue_core::{CameraPose, Plane, Ray};
use glam::{DVec2, DVec3};

/// A stored image of a camera in the world.
pub(super) struct PosedImage<'a> {
    pub(super) stored: &'a StoredRadianceImage<'a>,
    pub(super) distance: &'a Plane<Length>,
    pub(super) pose: &'a CameraPose,
}

impl PosedImage<'_> {
    /// Direction of a pixel's ray, in the camera's frame.
    pub(super) fn direction(&self, i: usize) -> Option<DVec3> {
        let (x, y) = (i % self.distance.width(), i / self.distance.width());
        self.direction_at(DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
    }

    /// Direction of an image point, in the camera's frame.
    pub(super) fn direction_at(&self, px: DVec2) -> Option<DVec3> {
        self.stored.projection.direction(px)
    }

    /// Pixel that contains a direction of the camera's frame.
    pub(super) fn pixel(&self, direction: DVec3) -> Option<usize> {
        let view = self.stored.projection.view(direction)?;
        let px = view.px(direction).filter(|px| view.holds(*px))?;
        Some(px.y as usize * self.distance.width() + px.x as usize)
    }

    /// Pixel that contains a point (m from the camera, along the world's axes), and the number of pixels covered by a square metre there that is
    /// perpendicular to the line of sight to a position `away_m` from the camera.
    pub(super) fn pixel_and_area(&self, point_m: DVec3, away_m: f64) -> Option<(usize, f64)> {
        let direction = self.pose.rotation.transpose() * point_m;
        let ahead_m = self.stored.projection.view(direction)?.face().axes()[2].dot(direction);
        let pitch = self.stored.projection.pitch_tan();
        // Of the plane at unit distance: away (ahead)⁻³.
        let area_px = away_m / (ahead_m * ahead_m * ahead_m) / (pitch * pitch);
        self.pixel(direction).map(|pixel| (pixel, area_px))
    }

    /// Solid angle of a pixel, sr, up to a factor that all pixels share.
    pub(super) fn solid_angle(&self, i: usize) -> f64 {
        let Some(direction) = self.direction(i) else { return 0.0 };
        let Some(view) = self.stored.projection.view(direction) else { return 0.0 };
        let cos = view.face().axes()[2].dot(direction);
        cos * cos * cos
    }

    /// Ray from the camera to the surface that a pixel sees; of zero length without a ray.
    pub(super) fn ray(&self, i: usize) -> Ray {
        let (direction, distance) = (self.direction(i), self.distance.samples()[i]);
        let towards = self.pose.rotation * direction.unwrap_or(DVec3::Z);
        let mut ray = Ray::new(glam::Vec3::ZERO, towards.as_vec3(), 0.0);
        ray.t_max = if direction.is_none() || distance.is_nan() { 0.0 } else { distance };
        ray
    }

    /// Pixels that show the sky up to an elevation, rad.
    pub(super) fn sky(&self, elevation_rad: f64) -> Vec<usize> {
        let shows = |i: &usize| {
            self.distance.samples()[*i] == f32::INFINITY
                && self.direction(*i).is_some_and(|direction| {
                    let z = (self.pose.rotation * direction).z.clamp(-1.0, 1.0);
                    (0.0..=elevation_rad.min(FRAC_PI_2)).contains(&asin(z))
                })
        };
        (0..self.distance.samples().len()).filter(shows).collect()
    }

    pub(super) fn depth(&self) -> Plane<Length> {
        let mut depth = self.distance.clone();
        for (i, depth) in depth.samples_mut().iter_mut().enumerate() {
            if depth.is_finite() {
                *depth = self.direction(i).map_or(f32::NAN, |direction| (f64::from(*depth) * direction.z) as f32);
            }
        }
        depth
    }
}
