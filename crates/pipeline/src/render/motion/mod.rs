//! Ground truth of motion: positions, in other frames, of the surface points that a pixel sees, and their velocities.
//!
//! Traced along the same principal rays as the ground truth (587.56 nm, pixel centres), each at the middle of its row's exposure. The hit point is fixed in
//! its instance's own frame (on its triangle, if vertices move), moved with the instance to the time of the other frame, seen from the camera's pose at that
//! time, and projected by the lens with its distortion. In a frame of a rolling shutter that time is that of the row where the point appears
//! ([`FrameView::middle_at_s`]). NaN marks points without an image: behind the camera, outside the lens's field, outside a mirror.
//!
//! For two frames of one camera this is optical flow; for two cameras with rectified views, disparity.
//!
//! Not included: motion of the background (it is infinitely distant and does not rotate; only a rotation of the camera moves it); reflections and objects
//! seen through glass, whose images move differently (the surface of the pane or mirror is followed); captures of a frame with several exposures (the times
//! of the first are used).

mod correspondence;
mod image_point;
mod neighbour;
mod surface_path;
#[cfg(test)]
mod tests;

pub(crate) use correspondence::image_of;
pub use neighbour::{NeighbourTruth, Visibility};

use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::look_at::GroundTruthView;
use correspondence::{PixelView, image_velocity};
use etendue_core::Plane;
use etendue_core::quantity::{Disparity, Identity, ImageVelocity, Time, Vector};
use etendue_tracer::accel::Simd;
use glam::DVec2;
use neighbour::Neighbour;
use neighbour::plane;
use rayon::prelude::*;
pub(crate) use surface_path::OwnPoint;
use surface_path::SurfacePath;

/// Ground truth of motion of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionTruth {
    /// Motion to the requested frames, in their order.
    pub neighbours: Vec<NeighbourTruth>,
    /// Image velocity of the point that a pixel sees, at the pixel's time, px/s; NaN without one.
    pub motion_vector: Plane<ImageVelocity>,
    /// World velocity of the point that a pixel sees, m/s; NaN for the background.
    pub velocity: Plane<Vector>,
    /// Time of the pixel's ray, s from the frame's start.
    pub time: Plane<Time>,
}

/// Hit of a pixel, and its images in other frames.
struct PixelMotion {
    motion_vector: [f32; 2],
    velocity: [f32; 3],
    time_s: f32,
    neighbours: Vec<neighbour::NeighbourResult>,
}

/// Returns the maximum memory per pixel, bytes, while its motion relative to `neighbours` frames is computed: its hit and the planes.
pub(crate) fn bytes_of_pixel(neighbours: usize) -> f64 {
    // An allocation has an overhead of two words.
    let pixel_bytes =
        size_of::<PixelMotion>() + neighbours * size_of::<neighbour::NeighbourResult>() + 2 * size_of::<usize>();
    let planes = size_of::<[f32; 2]>() + size_of::<[f32; 3]>() + size_of::<f32>();
    (pixel_bytes + planes + (neighbours + 1) * size_of::<neighbour::NeighbourResult>()) as f64
}

/// Ground truth of motion of a frame relative to others of the same world. Runs on the caller's pool.
#[must_use]
pub fn motion_truth(plan: &Plan, frame: &FrameView<'_>, others: &[FrameView<'_>], simd: Simd) -> MotionTruth {
    let (width, height) = (frame.body().raster.width(), frame.body().raster.height());
    let looks_at = GroundTruthView::new(plan, frame, simd);
    let neighbours: Vec<Neighbour<'_>> = others.iter().map(|other| Neighbour::new(plan, other, simd)).collect();
    let pixels: Vec<PixelMotion> = (0..width * height)
        .into_par_iter()
        .map(|i| pixel_motion(plan, &looks_at, &neighbours, DVec2::new((i % width) as f64, (i / width) as f64) + 0.5))
        .collect();
    MotionTruth {
        neighbours: (0..others.len())
            .map(|n| NeighbourTruth::new(width, &pixels.iter().map(|pixel| pixel.neighbours[n]).collect::<Vec<_>>()))
            .collect(),
        motion_vector: plane(&pixels, width, |pixel| pixel.motion_vector),
        velocity: plane(&pixels, width, |pixel| pixel.velocity),
        time: plane(&pixels, width, |pixel| pixel.time_s),
    }
}

/// Disparity: the column at which a frame of the left camera sees a point minus that at which a frame of the right camera does, px, for rectified views
/// (parallel, equal, displaced along their rows); with the visibility in the right camera.
#[must_use]
pub fn disparity(
    plan: &Plan,
    left: &FrameView<'_>,
    right: &FrameView<'_>,
    simd: Simd,
) -> (Plane<Disparity>, Plane<Identity>) {
    let mut truth = motion_truth(plan, left, &[*right], simd);
    let other = truth.neighbours.remove(0);
    (other.flow.map(|[u, _]| -u), other.visibility)
}

fn pixel_motion(
    plan: &Plan,
    looks_at: &GroundTruthView<'_>,
    neighbours: &[Neighbour<'_>],
    at_px: DVec2,
) -> PixelMotion {
    let nothing = || PixelMotion {
        motion_vector: [f32::NAN; 2],
        velocity: [f32::NAN; 3],
        time_s: looks_at.ray_time_s(at_px.y as usize),
        neighbours: vec![neighbour::NeighbourResult::default(); neighbours.len()],
    };
    let Some(ray) = looks_at.ray(at_px) else { return nothing() };
    let (line, pose, time_s) = (&ray.front.ray, &ray.pose, ray.time_s);
    let surface = match looks_at.first_hit(pose, line.origin_m, line.direction, ray.ray_time_s, None) {
        None => SurfacePath::Background(pose.direction_to_world(line.direction)),
        Some(truth) => SurfacePath::from_hit(plan, &truth, time_s),
    };
    let pixel_view = PixelView { at_px, off_centre: ray.off_centre };
    let here = surface.target_from(pose, time_s);
    let image_velocity = image_velocity(&looks_at.frame, &surface, pixel_view, time_s);
    PixelMotion {
        motion_vector: image_velocity.map_or([f32::NAN; 2], |v| v.as_vec2().to_array()),
        velocity: surface.velocity_m_s(time_s).map_or([f32::NAN; 3], |v| v.as_vec3().to_array()),
        neighbours: neighbours.iter().map(|other| other.find(&surface, pixel_view, here)).collect(),
        ..nothing()
    }
}
