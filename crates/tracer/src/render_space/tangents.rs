//! Directions in which texture coordinates grow. Looked up where a material asks.

use crate::geometry::InstanceTransform;
use crate::geometry::MeshPose;
use glam::{DVec2, DVec3, Vec3};

/// ∂p/∂u and ∂p/∂v of a triangle in its own frame, up to their lengths: texture coordinates are linear over it.
pub(super) fn of_mesh(mesh: &MeshPose<'_>, primitive: u32) -> Option<[DVec3; 2]> {
    let uvs = mesh.uvs(primitive)?;
    let [a, b, c] = mesh.corners(primitive).map(Vec3::as_dvec3);
    let (along, across) = (b - a, c - a);
    let [a, b, c]: [DVec2; 3] = uvs.map(|uv| uv.as_dvec2());
    let (uv_along, uv_across) = (b - a, c - a);
    let turn = uv_along.perp_dot(uv_across);
    let side = if turn < 0.0 { -1.0 } else { 1.0 };
    let u = (along * uv_across.y - across * uv_along.y) * side;
    let v = (across * uv_along.x - along * uv_across.x) * side;
    (turn != 0.0).then_some([u, v])
}

/// East and north at a point of a sphere about the origin, up to their lengths; `None` at the poles.
pub(super) fn of_sphere(point: DVec3) -> Option<[DVec3; 2]> {
    let east = DVec3::Z.cross(point);
    (east != DVec3::ZERO).then(|| [east, point.cross(east)])
}

/// Two directions of the instance's frame as unit ones of the render frame.
pub(super) fn to_render(local: [DVec3; 2], placed: &InstanceTransform) -> Option<[Vec3; 2]> {
    let [u, v] = local.map(|d| placed.vector_to_render(d).try_normalize());
    Some([u?.as_vec3(), v?.as_vec3()])
}
