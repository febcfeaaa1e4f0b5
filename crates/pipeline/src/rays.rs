//! The ray table: by which ray each pixel looks.
//!
//! The same rays as the ground truth's: of pixels' centres, through the centre of the pupil at 587.56 nm, or through the
//! centroid of its open part where that is clipped. A point at distance d (`distance.Z` of the ground truth) is seen from
//! pose · (origin + d direction), to rounding: 32-bit floats keep 6e-8 of the distance.

use crate::plan::CameraBody;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Vector};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Rays of all pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTable {
    /// Where they begin, camera frame, m; NaN where there is none.
    pub origin: Plane<Vector>,
    /// Unit direction into the scene, camera frame; NaN where there is none.
    pub direction: Plane<Vector>,
    /// 0 no ray, 1 the principal ray, 2 one through the centroid of the open pupil.
    pub ray: Plane<Identity>,
}

/// The ray table of a camera, on the caller's pool.
#[must_use]
pub fn ray_table(body: &CameraBody) -> RayTable {
    let (width, height) = (body.raster.width(), body.raster.height());
    let rays: Vec<_> = (0..width * height)
        .into_par_iter()
        .map(|i| {
            let centre = DVec2::new((i % width) as f64, (i / width) as f64) + 0.5;
            body.lens.truth_ray(body.raster.sensor_mm(centre))
        })
        .collect();
    let vector = |of: fn(&etendue_core::PupilRay) -> DVec3| {
        let samples = rays.iter().map(|r| r.as_ref().map_or([f32::NAN; 3], |r| of(&r.ray).as_vec3().to_array()));
        Plane::from_samples(width, height, samples.collect()).expect("one sample a pixel")
    };
    let kind = rays.iter().map(|r| r.as_ref().map_or(0, |r| 1 + u32::from(r.off_centre))).collect();
    RayTable {
        origin: vector(|ray| ray.origin_m),
        direction: vector(|ray| ray.direction),
        ray: Plane::from_samples(width, height, kind).expect("one sample a pixel"),
    }
}
