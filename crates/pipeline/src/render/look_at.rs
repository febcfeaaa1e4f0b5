//! Traces a pixel's ray of ground truth at the pixel's own time.

use super::frame_view::FrameView;
use super::truth::is_there;
use crate::plan::Plan;
use etendue_core::CameraPose;
use etendue_optics::FrontRay;
use etendue_tracer::accel::Simd;
use etendue_tracer::render_space::{RenderSpace, Truth};
use glam::{DVec2, DVec3};

/// A frame of a camera and the world during it.
pub(crate) struct GroundTruthView<'a> {
    pub(crate) frame: FrameView<'a>,
    plan: &'a Plan,
    view: RenderSpace<'a>,
}

/// Ray of a pixel.
pub(crate) struct PixelRay {
    /// Ray in the camera's frame.
    pub(crate) front: FrontRay,
    /// Second value of `CameraBody::truth_ray`.
    pub(crate) off_centre: bool,
    /// Time of the ray, s from the frame's start.
    pub(crate) ray_time_s: f32,
    /// Simulated time of the ray, s.
    pub(crate) time_s: f64,
    /// Pose of the camera at that time.
    pub(crate) pose: CameraPose,
}

impl<'a> GroundTruthView<'a> {
    pub(crate) fn new(plan: &'a Plan, frame: &FrameView<'a>, simd: Simd) -> Self {
        let origin_m = frame.pose_at(frame.interval().middle_s()).position_m;
        let view = plan.world.render_space_with(origin_m, frame.interval(), simd);
        Self { frame: *frame, plan, view }
    }

    /// Time of a row's rays, s from the frame's start. Rays have times of 32 bits.
    pub(crate) fn ray_time_s(&self, row: usize) -> f32 {
        (self.frame.row_middle_s(row) - self.view.interval().start_s()) as f32
    }

    /// Ray of an image point (px) at the time of its row; `None` where no light arrives.
    pub(crate) fn ray(&self, at_px: DVec2) -> Option<PixelRay> {
        let (front, off_centre) = self.frame.body().truth_ray(at_px)?;
        let ray_time_s = self.ray_time_s(at_px.y as usize);
        let time_s = self.view.interval().moment(ray_time_s);
        Some(PixelRay { front, off_centre, ray_time_s, time_s, pose: self.frame.pose_at(time_s) })
    }

    /// First hit from a point of the camera's frame (m) along a direction of it, with the camera at `pose` at a time.
    pub(crate) fn first_hit(
        &self,
        pose: &CameraPose,
        origin_m: DVec3,
        direction: DVec3,
        ray_time_s: f32,
        instance: Option<u32>,
    ) -> Option<Truth> {
        // The view's origin is the camera's position at the middle of the frame.
        let from_m = pose.position_m - self.view.origin_m() + pose.point_to_render(origin_m);
        let is_wanted = |index: u32| instance.is_none_or(|wanted_index| wanted_index == index);
        self.view.truth(from_m, pose.direction_to_world(direction), ray_time_s, |point| {
            is_wanted(point.instance) && is_there(&self.view, &self.plan.material_table, point)
        })
    }

    /// Returns true if an image point would show an instance (its index in the world's list) if that were alone.
    pub(crate) fn would_show(&self, at_px: DVec2, instance: u32) -> bool {
        let hit = self.ray(at_px).and_then(|ray| {
            let line = ray.front.ray;
            self.first_hit(&ray.pose, line.origin_m, line.direction, ray.ray_time_s, Some(instance))
        });
        hit.is_some_and(|truth| truth.instance == instance)
    }
}
