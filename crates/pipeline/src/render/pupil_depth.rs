//! Distance of the scene from the centre of the entrance pupil: the ground truth of a stored radiance image.
//!
//! One ray through the centre of each stored pixel, never filtered. An image uses the nearest stored pixel for each of its own pixels; its direction differs
//! by at most half a stored pixel's diagonal (not at all without distortion). On a surface seen at the angle α from its normal the relative error of
//! distances is tan α times that angle.

use crate::plan::{CameraPlan, Plan, Route};
use crate::render::exposure::{FilmExposure, FrameCapture};
use crate::render::truth::{GroundTruthHit, Viewpoint, trace, truth_time_s};
use etendue_core::quantity::Length;
use etendue_core::{Plane, PupilRay};
use etendue_optics::FrontRay;
use etendue_tracer::accel::Simd;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Distances seen by the pixels of a stored radiance image.
#[derive(Clone, Debug, PartialEq)]
pub struct PupilDepth {
    /// Along the pixel's ray from the pupil's centre, m; +∞ for the sky, NaN between views.
    pub distance: Plane<Length>,
    /// Along the optical axis, m; +∞ for the sky, NaN between views and where a pixel does not look forward.
    pub depth: Plane<Length>,
}

/// Distances for a camera on the pupil route at the middle of a frame's exposure; `None` on the lens route. Runs on the caller's pool.
#[must_use]
pub fn pupil_depth(plan: &Plan, camera: &CameraPlan, frame: u32, simd: Simd) -> Option<PupilDepth> {
    let Route::Pupil(projection) = &camera.settings.route else { return None };
    let (width, height) = (projection.width(), projection.height());
    let exposure = FilmExposure::new(camera, FrameCapture { frame, capture: 0 });
    let view = plan.world.render_space_with(exposure.origin_m(), exposure.interval(), simd);
    let viewpoint = Viewpoint::new(&view, camera, truth_time_s(camera, frame, 0));
    let hit_of = |i: usize| {
        let direction = projection.direction(DVec2::new((i % width) as f64, (i / width) as f64) + 0.5);
        direction.map_or(GroundTruthHit::Nothing, |direction| {
            let ray = PupilRay { origin_m: DVec3::ZERO, direction, weight_sr: 1.0 };
            trace(&view, &plan.material_table, &viewpoint, &FrontRay::without_front(ray))
        })
    };
    let pairs = (0..width * height).into_par_iter().map(hit_of).map(|hit| (hit.distance(), hit.depth()));
    let (distance, depth): (Vec<f32>, Vec<f32>) = pairs.unzip();
    let plane = |samples| Plane::from_samples(width, height, samples).expect("one sample a pixel");
    Some(PupilDepth { distance: plane(distance), depth: plane(depth) })
}
