//! Boxes in space.

use crate::plan::Plan;
use etendue_core::CameraPose;
use etendue_tracer::geometry::{Instance, Shape};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A box in space, oriented like its object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidBox {
    /// Lengths along its own axes x, y, z, m.
    pub size_m: DVec3,
    /// Pose in the world.
    pub world: BoxPose,
    /// Pose in the camera's frame (x right, y down, z forward) at the same time.
    pub camera: BoxPose,
}

/// Pose of a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxPose {
    pub centre_m: DVec3,
    /// Rotation from its own axes to those of the frame; of the two equivalent quaternions the one with w ≥ 0.
    pub rotation: DQuat,
}

impl SolidBox {
    /// Box of an instance's shape at a time, along the axes of its object (x forward, y left, z up; whatever the axes of a mesh's file). A frame with
    /// non-uniform scale after a rotation has sheared axes: the box is then aligned to the first of them and contains the whole shape.
    pub(super) fn new(plan: &Plan, instance: &Instance, time_s: f64, pose: &CameraPose) -> Self {
        let (size_m, world) = Self::in_world(plan, instance, time_s);
        let axes = object_axes(plan, instance, time_s);
        let to_camera = DAffine3::from_mat3_translation(pose.rotation, pose.position_m).inverse();
        let camera = BoxPose {
            centre_m: to_camera.transform_point3(world.centre_m),
            rotation: quaternion(to_camera.matrix3 * axes),
        };
        Self { size_m, world, camera }
    }

    /// Size, m, and pose in the world.
    pub(crate) fn in_world(plan: &Plan, instance: &Instance, time_s: f64) -> (DVec3, BoxPose) {
        let to_world = instance.to_world.at(time_s);
        let axes = object_axes(plan, instance, time_s);
        let corners =
            corners(plan, instance, time_s).map(|corner| axes.transpose() * to_world.transform_vector3(corner));
        let low = corners.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = corners.iter().copied().reduce(DVec3::max).unwrap_or_default();
        let centre_m = to_world.translation + axes * ((low + high) * 0.5);
        (high - low, BoxPose { centre_m, rotation: quaternion(axes) })
    }
}

/// Rotation from an object's axes to the world at a time.
fn object_axes(plan: &Plan, instance: &Instance, time_s: f64) -> DMat3 {
    let axes = plan.identity(instance.instance_id).map_or(DMat3::IDENTITY, |identity| identity.axes);
    orthonormalised(&(instance.to_world.at(time_s).matrix3 * axes))
}

/// Corners of the box around a shape at a time, in its own frame.
fn corners(plan: &Plan, instance: &Instance, time_s: f64) -> [DVec3; 8] {
    let (low, high) = match instance.shape {
        Shape::Mesh(id) => plan
            .world
            .mesh(id)
            .at(time_s)
            .bounds()
            .map_or((DVec3::ZERO, DVec3::ZERO), |(low, high)| (low.as_dvec3(), high.as_dvec3())),
        Shape::Sphere { radius_m } => (DVec3::splat(-radius_m), DVec3::splat(radius_m)),
    };
    core::array::from_fn(|i| DVec3::select(glam::BVec3::new(i & 1 == 0, i & 2 == 0, i & 4 == 0), low, high))
}

/// Rotation from the axes of a matrix, orthogonalised one after the other; z is reversed if the matrix mirrors.
fn orthonormalised(matrix: &DMat3) -> DMat3 {
    let x = matrix.x_axis.normalize();
    let y = (matrix.y_axis - x * x.dot(matrix.y_axis)).normalize();
    DMat3::from_cols(x, y, x.cross(y))
}

fn quaternion(axes: DMat3) -> DQuat {
    let q = DQuat::from_mat3(&axes);
    if q.w < 0.0 { -q } else { q }
}
