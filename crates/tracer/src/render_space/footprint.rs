//! How large textures and shapes are about a point, for filtering, and directions in which texture coordinates grow. Looked up where a material asks.

use core::f64::consts::{PI, TAU};
use glam::{DVec2, DVec3, Vec3};

use crate::geometry::{Footprint, InstanceTransform, MeshPose, sphere};

pub(super) fn mesh_footprint(mesh: &MeshPose<'_>, placed: &InstanceTransform, primitive: u32) -> Footprint {
    Footprint { uv_per_m: uv_per_m(mesh, placed, primitive), local_per_m: local_per_m(placed) }
}

pub(super) fn sphere_footprint(radius_m: f64, placed: &InstanceTransform) -> Footprint {
    let uv_per_m = sphere::uv_per_m(radius_m * placed.mean_scale()) as f32;
    Footprint { uv_per_m, local_per_m: local_per_m(placed) }
}

/// How texture coordinates change along a vector of a mesh's own frame in the plane of a triangle.
pub(super) fn uv_along(mesh: &MeshPose<'_>, primitive: u32, vector: DVec3) -> DVec2 {
    let Some(uvs) = mesh.uvs(primitive) else { return DVec2::ZERO };
    let [a, b, c] = mesh.corners(primitive).map(Vec3::as_dvec3);
    let (along, across) = (b - a, c - a);
    let normal = along.cross(across);
    let weights =
        DVec2::new(normal.dot(vector.cross(across)), normal.dot(along.cross(vector))) / normal.length_squared();
    let [a, b, c]: [DVec2; 3] = uvs.map(|uv| uv.as_dvec2());
    (b - a) * weights.x + (c - a) * weights.y
}

/// How longitude (turns) and latitude (half turns) change along a vector at a point of a sphere about the origin; zero
/// at the poles.
pub(super) fn globe_along(point: DVec3, vector: DVec3) -> DVec2 {
    let east = DVec3::Z.cross(point);
    let (flat, square) = (east.length(), point.length_squared());
    if flat == 0.0 {
        return DVec2::ZERO;
    }
    let north = point.cross(east) / flat;
    DVec2::new(vector.dot(east) / (flat * flat * TAU), vector.dot(north) / (square * PI))
}

/// Root of the ratio of a triangle's areas in texture units and in the render frame.
fn uv_per_m(mesh: &MeshPose<'_>, placed: &InstanceTransform, primitive: u32) -> f32 {
    let Some(uvs) = mesh.uvs(primitive) else { return 0.0 };
    let [a, b, c]: [DVec2; 3] = uvs.map(|uv| uv.as_dvec2());
    let texture = (b - a).perp_dot(c - a).abs();
    let [a, b, c]: [DVec3; 3] = mesh.corners(primitive).map(Vec3::as_dvec3).map(|p| placed.point_to_render(p));
    (texture / (b - a).cross(c - a).length()).sqrt() as f32
}

fn local_per_m(placed: &InstanceTransform) -> f32 {
    (1.0 / placed.mean_scale()) as f32
}

/// ∂p/∂u and ∂p/∂v of a triangle in its own frame, up to their lengths: texture coordinates are linear over it.
pub(super) fn mesh_tangents(mesh: &MeshPose<'_>, primitive: u32) -> Option<[DVec3; 2]> {
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
pub(super) fn sphere_tangents(point: DVec3) -> Option<[DVec3; 2]> {
    let east = DVec3::Z.cross(point);
    (east != DVec3::ZERO).then(|| [east, point.cross(east)])
}

/// Two directions of the instance's frame as unit ones of the render frame.
pub(super) fn tangents_to_render(local: [DVec3; 2], placed: &InstanceTransform) -> Option<[Vec3; 2]> {
    let [u, v] = local.map(|d| placed.vector_to_render(d).try_normalize());
    Some([u?.as_vec3(), v?.as_vec3()])
}
