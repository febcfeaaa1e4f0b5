//! The ray table: the ray of each pixel.
//!
//! The same rays as the ground truth's: of pixel centres, through the centre of the pupil at 587.56 nm, or through the centroid of its open part if that ray
//! is clipped. A point at distance d (`distance.Z` of the ground truth) is at pose · (origin + d direction), up to rounding: 32-bit floats have a relative
//! error of 6e-8. With a mirror the origin is the point on the mirror and d counts from the pupil: pose · (origin + (d − path) direction).

use crate::plan::CameraBody;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Length, Vector};
use etendue_optics::FrontRay;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Rays of all pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTable {
    /// Origins, camera frame, m; NaN without a ray.
    pub origin: Plane<Vector>,
    /// Unit directions into the scene, camera frame; NaN without a ray.
    pub direction: Plane<Vector>,
    /// 0 no ray, 1 the principal ray, 2 one through the centroid of the open pupil.
    pub ray: Plane<Identity>,
    /// For a camera with a mirror, with the origins on it: the path from the pupil to the mirror, m; 0 outside the mirror.
    pub path: Option<Plane<Length>>,
}

/// Ray table of a camera. Runs on the caller's pool.
#[must_use]
pub fn ray_table(body: &CameraBody) -> RayTable {
    let (width, height) = (body.raster.width(), body.raster.height());
    let rays: Vec<_> = (0..width * height)
        .into_par_iter()
        .map(|i| {
            let centre = DVec2::new((i % width) as f64, (i / width) as f64) + 0.5;
            body.truth_ray(centre)
        })
        .collect();
    let vector = |of: fn(&FrontRay) -> DVec3| {
        let samples = rays.iter().map(|r| r.as_ref().map_or([f32::NAN; 3], |(ray, _)| of(ray).as_vec3().to_array()));
        Plane::from_samples(width, height, samples.collect()).expect("one sample a pixel")
    };
    let kind = rays.iter().map(|r| r.as_ref().map_or(0, |(_, off_centre)| 1 + u32::from(*off_centre))).collect();
    let path = |(ray, _): &(FrontRay, bool)| ray.mirror_m.map_or(0.0, |_| ray.path_m as f32);
    let paths = rays.iter().map(|r| r.as_ref().map_or(f32::NAN, path)).collect();
    let has_mirror = rays.iter().flatten().any(|(ray, _)| ray.mirror_m.is_some());
    RayTable {
        origin: vector(FrontRay::truth_origin_m),
        direction: vector(|ray| ray.ray.direction),
        ray: Plane::from_samples(width, height, kind).expect("one sample a pixel"),
        path: has_mirror.then(|| Plane::from_samples(width, height, paths).expect("one sample a pixel")),
    }
}
