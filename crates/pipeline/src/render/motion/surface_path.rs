//! Path of the surface point that a pixel sees, over time.

use super::image_point::ImageTarget;
use crate::plan::Plan;
use etendue_core::{CameraPose, Motion};
use etendue_tracer::geometry::{Mesh, Shape};
use etendue_tracer::render_space::Truth;
use glam::DVec3;

/// A point of a surface, which moves with its instance, or a direction of the background.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SurfacePath<'w> {
    Point {
        /// In the instance's own frame.
        own: OwnPoint<'w>,
        /// Transform from there to the world.
        to_world: &'w Motion,
    },
    /// A direction of the world: the background is infinitely distant and does not rotate.
    Background(DVec3),
}

/// A surface point in its instance's own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) enum OwnPoint<'w> {
    /// A constant position.
    Fixed(DVec3),
    /// A point of a triangle with moving vertices, by barycentric weights.
    Between {
        mesh: &'w Mesh,
        vertices: [u32; 3],
        /// Their weights, with sum 1.
        weights: [f64; 3],
    },
}

impl<'w> OwnPoint<'w> {
    /// Point at a position of an instance's own frame at a time, on a triangle of its mesh or a sphere.
    fn at_place(place: DVec3, mesh: Option<&'w Mesh>, primitive: u32, time_s: f64) -> Self {
        let Some(mesh) = mesh.filter(|mesh| mesh.animation().is_some()) else { return Self::Fixed(place) };
        let (vertices, pose) = (mesh.triangles()[primitive as usize], mesh.at(time_s));
        let [a, b, c] = vertices.map(|vertex| pose.exact_position(vertex));
        let (edge, across, inside) = (b - a, c - a, place - a);
        let normal = edge.cross(across);
        let square = normal.length_squared();
        let (u, v) = (normal.dot(inside.cross(across)) / square, normal.dot(edge.cross(inside)) / square);
        Self::Between { mesh, vertices, weights: [1.0 - u - v, u, v] }
    }

    /// Position at a time.
    fn at(&self, time_s: f64) -> DVec3 {
        match self {
            Self::Fixed(place) => *place,
            Self::Between { mesh, vertices, weights } => {
                let pose = mesh.at(time_s);
                let [a, b, c] = vertices.map(|vertex| pose.exact_position(vertex));
                a * weights[0] + b * weights[1] + c * weights[2]
            }
        }
    }
}

/// Half the time between two positions whose difference gives a velocity, s: at 100 revolutions per second on a wheel of 0.3 m the error is 3e-4 of its 190
/// m/s; positions of 10⁶ m are rounded by 1e-10 m, which gives 6e-6 m/s.
pub(super) const HALF_STEP_S: f64 = 2e-5;

impl<'w> SurfacePath<'w> {
    /// Path of the point that an instance shows at a position in the world (m) at a time.
    pub(crate) fn from_hit(plan: &'w Plan, truth: &Truth, time_s: f64) -> Self {
        let instance = &plan.world.instances()[truth.instance as usize];
        let mesh = match instance.shape {
            Shape::Mesh(id) => Some(plan.world.mesh(id)),
            Shape::Sphere { .. } => None,
        };
        let to_world = &instance.to_world;
        let place = to_world.at(time_s).inverse().transform_point3(truth.position_m);
        Self::Point { own: OwnPoint::at_place(place, mesh, truth.primitive, time_s), to_world }
    }

    /// The target as seen by a camera at a time.
    pub(crate) fn target_from(&self, pose: &CameraPose, time_s: f64) -> ImageTarget {
        match self {
            Self::Point { own, to_world } => {
                ImageTarget::Point(pose.point_to_camera(to_world.at(time_s).transform_point3(own.at(time_s))))
            }
            Self::Background(direction) => ImageTarget::Direction(pose.rotation.transpose() * *direction),
        }
    }

    /// Velocity in the world at a time, m/s; `None` for the background. At a key, or a vertex frame, where the velocity jumps, the mean of both.
    pub(crate) fn velocity_m_s(&self, time_s: f64) -> Option<DVec3> {
        let Self::Point { own, to_world } = self else { return None };
        if to_world.as_constant().is_some() && matches!(own, OwnPoint::Fixed(_)) {
            return Some(DVec3::ZERO);
        }
        let at = |time_s: f64| to_world.at(time_s).transform_point3(own.at(time_s));
        Some((at(time_s + HALF_STEP_S) - at(time_s - HALF_STEP_S)) / (2.0 * HALF_STEP_S))
    }
}
