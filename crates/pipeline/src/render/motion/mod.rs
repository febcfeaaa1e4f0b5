//! Ground truth of motion: where what a pixel sees is seen in other frames, and how it moves.
//!
//! Along the same principal rays as the ground truth (587.56 nm, pixel centres), each at the middle of its row's exposure. What is seen there is
//! held fast in its instance's own frame, moved with the instance to the time of the other frame, seen from where the camera then stands, and
//! projected by the lens with its distortion. In a frame of a rolling shutter that time is that of the row where the point appears
//! ([`FrameView::middle_at_s`]). What is not a number has no image: behind the camera, outside the lens's field, beside a mirror.
//!
//! Of two frames of one camera this is optical flow; of two cameras whose views are rectified, disparity.
//!
//! Left out: motion of the background (it is infinitely far and does not turn: a camera's own turning moves it); reflections and what
//! is seen through glass, whose images move otherwise (the pane's or mirror's own surface is followed); captures of a frame with several
//! exposures (the first one's times are used).

mod correspondence;
mod frame_view;
mod image_point;
mod neighbour;
mod surface_path;
#[cfg(test)]
mod tests;

pub use frame_view::FrameView;
pub use neighbour::{NeighbourTruth, Visibility};

use crate::plan::Plan;
use crate::render::truth::is_there;
use correspondence::{Sight, image_velocity};
use etendue_core::quantity::{Disparity, Identity, ImageVelocity, Quantity, Time, Vector};
use etendue_core::{CameraPose, Plane};
use etendue_tracer::accel::Simd;
use etendue_tracer::render_space::RenderSpace;
use glam::{DVec2, DVec3};
use neighbour::Neighbour;
use rayon::prelude::*;
use surface_path::SurfacePath;

/// The truth of motion of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionTruth {
    /// In the frames asked for, in their order.
    pub neighbours: Vec<NeighbourTruth>,
    /// Velocity of the image of what a pixel sees, at its time, px/s; NaN where there is none.
    pub motion_vector: Plane<ImageVelocity>,
    /// Velocity in the world of what a pixel sees, m/s; NaN for the background.
    pub velocity: Plane<Vector>,
    /// The time at which the pixel looks, s from the frame's start.
    pub time: Plane<Time>,
}

/// What a pixel sees, and where it is seen in other frames.
struct Look {
    motion_vector: [f32; 2],
    velocity: [f32; 3],
    time_s: f32,
    neighbours: Vec<neighbour::Found>,
}

/// The truth of motion of a frame against others of the same world, on the caller's pool.
#[must_use]
pub fn motion_truth(plan: &Plan, frame: &FrameView<'_>, others: &[FrameView<'_>], simd: Simd) -> MotionTruth {
    let (width, height) = (frame.body.raster.width(), frame.body.raster.height());
    let view = render_space(plan, frame, simd);
    let neighbours: Vec<Neighbour<'_>> = others.iter().map(|other| Neighbour::new(plan, *other, simd)).collect();
    let looks: Vec<Look> = (0..width * height)
        .into_par_iter()
        .map(|i| look(plan, &view, frame, &neighbours, DVec2::new((i % width) as f64, (i / width) as f64) + 0.5))
        .collect();
    MotionTruth {
        neighbours: (0..others.len()).map(|n| NeighbourTruth::of(width, height, &looks, n)).collect(),
        motion_vector: plane(&looks, width, |look| look.motion_vector),
        velocity: plane(&looks, width, |look| look.velocity),
        time: plane(&looks, width, |look| look.time_s),
    }
}

/// Disparity: the column at which a frame of the left camera sees a point minus that at which one of the right camera does, px, whose views are
/// rectified (parallel, alike, apart along their rows), with where the right camera sees it.
#[must_use]
pub fn disparity(
    plan: &Plan,
    left: &FrameView<'_>,
    right: &FrameView<'_>,
    simd: Simd,
) -> (Plane<Disparity>, Plane<Identity>) {
    let mut truth = motion_truth(plan, left, &[*right], simd);
    let found = truth.neighbours.remove(0);
    (found.flow.map(|[u, _]| -u), found.visibility)
}

/// The world about a frame's camera, during the frame.
fn render_space<'p>(plan: &'p Plan, frame: &FrameView<'_>, simd: Simd) -> RenderSpace<'p> {
    plan.world.render_space_with(frame.path.at(frame.start_s).position_m, frame.interval(), simd)
}

/// A camera's point (m) in the render frame of a view, from a pose that need not be the view's own.
fn to_render(view: &RenderSpace<'_>, pose: &CameraPose, point_m: DVec3) -> DVec3 {
    pose.position_m - view.origin_m() + pose.point_to_render(point_m)
}

fn look(
    plan: &Plan,
    view: &RenderSpace<'_>,
    frame: &FrameView<'_>,
    neighbours: &[Neighbour<'_>],
    at_px: DVec2,
) -> Look {
    let interval = view.interval();
    let ray_time_s = (frame.row_middle_s(at_px.y as usize) - interval.start_s()) as f32;
    // Rays have times of 32 bits: the time that they mean is the pixel's.
    let time_s = interval.moment(ray_time_s);
    let nothing = || Look {
        motion_vector: [f32::NAN; 2],
        velocity: [f32::NAN; 3],
        time_s: ray_time_s,
        neighbours: vec![neighbour::Found::default(); neighbours.len()],
    };
    let Some((front, off_centre)) = frame.body.truth_ray(at_px) else { return nothing() };
    let pose = frame.path.at(time_s);
    let direction = pose.direction_to_world(front.ray.direction);
    let origin_m = to_render(view, &pose, front.ray.origin_m);
    let truth = view.truth(origin_m, direction, ray_time_s, |point| is_there(view, &plan.material_table, point));
    let surface = truth.map_or(SurfacePath::Background(direction), |truth| {
        let instance = &plan.world.instances()[truth.instance as usize];
        SurfacePath::of_point(truth.position_m, &instance.to_world, time_s)
    });
    let sight = Sight { at_px, off_centre };
    let here = surface.seen_from(&pose, time_s);
    Look {
        motion_vector: image_velocity(frame, &surface, sight, time_s).map_or([f32::NAN; 2], |v| v.as_vec2().to_array()),
        velocity: surface.velocity_m_s(time_s).map_or([f32::NAN; 3], |v| v.as_vec3().to_array()),
        neighbours: neighbours.iter().map(|other| other.find(plan, &surface, sight, here)).collect(),
        ..nothing()
    }
}

fn plane<Q: Quantity>(looks: &[Look], width: usize, of: impl Fn(&Look) -> Q::Sample) -> Plane<Q> {
    Plane::from_samples(width, looks.len() / width, looks.iter().map(of).collect()).expect("one sample a pixel")
}
