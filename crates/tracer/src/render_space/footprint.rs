//! How large textures and shapes are about a point, for filtering. Looked up where a material asks.

use crate::geometry::InstanceTransform;
use crate::geometry::{Footprint, MeshPose, sphere};
use core::f64::consts::{PI, TAU};
use glam::{DVec2, DVec3, Vec3};

pub(super) fn of_mesh(mesh: &MeshPose<'_>, placed: &InstanceTransform, primitive: u32) -> Footprint {
    Footprint { uv_per_m: uv_per_m(mesh, placed, primitive), local_per_m: local_per_m(placed) }
}

pub(super) fn of_sphere(radius_m: f64, placed: &InstanceTransform) -> Footprint {
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
