//! How large textures and shapes are about a point, for filtering. Looked up where a material asks.

use super::place::Placed;
use crate::geometry::{Footprint, Mesh, sphere};
use glam::{DVec2, DVec3, Vec3};

pub(super) fn of_mesh(mesh: &Mesh, placed: &Placed, primitive: u32) -> Footprint {
    Footprint { uv_per_m: uv_per_m(mesh, placed, primitive), local_per_m: local_per_m(placed) }
}

pub(super) fn of_sphere(radius_m: f64, placed: &Placed) -> Footprint {
    let uv_per_m = sphere::uv_per_m(radius_m * placed.mean_scale()) as f32;
    Footprint { uv_per_m, local_per_m: local_per_m(placed) }
}

/// Root of the ratio of a triangle's areas in texture units and in the render frame.
fn uv_per_m(mesh: &Mesh, placed: &Placed, primitive: u32) -> f32 {
    if mesh.uvs().is_empty() {
        return 0.0;
    }
    let triangle = mesh.triangles()[primitive as usize];
    let [a, b, c]: [DVec2; 3] = triangle.map(|v| mesh.uvs()[v as usize].as_dvec2());
    let texture = (b - a).perp_dot(c - a).abs();
    let [a, b, c]: [DVec3; 3] = mesh.corners(primitive).map(Vec3::as_dvec3).map(|p| placed.point_to_render(p));
    (texture / (b - a).cross(c - a).length()).sqrt() as f32
}

fn local_per_m(placed: &Placed) -> f32 {
    (1.0 / placed.mean_scale()) as f32
}
