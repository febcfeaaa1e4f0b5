//! What a pixel sees, over time.

use super::image_point::Target;
use etendue_core::{CameraPose, Motion};
use glam::DVec3;

/// A point of a surface, which moves with its instance, or a direction of the background.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SurfacePath<'w> {
    /// A point.
    Point {
        /// In the instance's own frame.
        local: DVec3,
        /// From there to the world.
        to_world: &'w Motion,
    },
    /// A direction of the world: the background is infinitely far and does not turn.
    Background(DVec3),
}

/// Half the time between two places of which a velocity is the difference, s: at 100 turns a second on a wheel of 0.3 m it is right to 3e-4 of
/// its 190 m/s; positions of 10⁶ m are rounded by 1e-10 m, which makes 6e-6 m/s.
pub(super) const HALF_STEP_S: f64 = 2e-5;

impl<'w> SurfacePath<'w> {
    /// The path of a point of the world (m) that belongs to an instance at a time.
    pub(crate) fn of_point(world_m: DVec3, to_world: &'w Motion, time_s: f64) -> Self {
        Self::Point { local: to_world.at(time_s).inverse().transform_point3(world_m), to_world }
    }

    /// How it is seen by a camera at a time.
    pub(crate) fn seen_from(&self, pose: &CameraPose, time_s: f64) -> Target {
        match self {
            Self::Point { local, to_world } => {
                Target::Point(pose.point_to_camera(to_world.at(time_s).transform_point3(*local)))
            }
            Self::Background(direction) => Target::Direction(pose.rotation.transpose() * *direction),
        }
    }

    /// Its velocity in the world at a time, m/s; `None` for the background. At a key where the velocity jumps, the mean of both.
    pub(crate) fn velocity_m_s(&self, time_s: f64) -> Option<DVec3> {
        let Self::Point { local, to_world } = self else { return None };
        if to_world.as_still().is_some() {
            return Some(DVec3::ZERO);
        }
        let at = |time_s: f64| to_world.at(time_s).transform_point3(*local);
        Some((at(time_s + HALF_STEP_S) - at(time_s - HALF_STEP_S)) / (2.0 * HALF_STEP_S))
    }
}
