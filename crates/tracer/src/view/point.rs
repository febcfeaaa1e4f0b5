//! From a hit to the point of the surface.
//!
//! Positions are made from the primitive, not from the ray: a triangle's from barycentric coordinates, a sphere's by
//! putting the ray's point back onto the sphere, both in f64. Their error is then that of rounding to f32, whatever the
//! length of the ray (after Wächter & Binder 2019, "A fast and robust method for avoiding self-intersection").

use super::Hit;
use super::place::Placed;
use crate::geometry::{Instance, Mesh, SurfacePoint, sphere};
use etendue_core::Ray;
use glam::{DVec2, DVec3, Vec2, Vec3};

pub(super) fn of_mesh(mesh: &Mesh, instance: &Instance, placed: &Placed, hit: &Hit) -> SurfacePoint {
    let triangle = mesh.triangles()[hit.primitive as usize];
    let weights = weights(f64::from(hit.u), f64::from(hit.v));
    let corners = mesh.corners(hit.primitive).map(Vec3::as_dvec3);
    let local = blend(corners, weights);
    let geometric = geometric_normal(corners, placed);
    let position = placed.point_to_render(local).as_vec3();
    SurfacePoint {
        position,
        position_error: placed.position_error(position, local),
        geometric_normal: geometric.as_vec3(),
        shading_normal: shading_normal(mesh, triangle, weights, placed, geometric).as_vec3(),
        uv: uv(mesh, triangle, weights),
        uv_per_m: uv_per_m(mesh, triangle, corners, placed),
        instance: hit.instance,
        primitive: hit.primitive,
        material: instance.materials[usize::from(mesh.slots()[hit.primitive as usize])],
    }
}

pub(super) fn of_sphere(radius_m: f64, instance: &Instance, placed: &Placed, ray: &Ray, hit: &Hit) -> SurfacePoint {
    let (origin, direction) = placed.ray_to_local(ray);
    let unit = (origin + direction * f64::from(hit.t)).try_normalize().unwrap_or(DVec3::Z);
    let local = unit * radius_m;
    let position = placed.point_to_render(local).as_vec3();
    let normal = placed.normal_to_render(unit).unwrap_or(DVec3::Z).as_vec3();
    let scale = placed.mean_scale();
    SurfacePoint {
        position,
        position_error: placed.position_error(position, local),
        geometric_normal: normal,
        shading_normal: normal,
        uv: sphere::uv(unit).as_vec2(),
        uv_per_m: sphere::uv_per_m(radius_m * scale) as f32,
        instance: hit.instance,
        primitive: hit.primitive,
        material: instance.materials[0],
    }
}

/// Weights of a triangle's three vertices.
pub(super) fn weights(u: f64, v: f64) -> [f64; 3] {
    [1.0 - u - v, u, v]
}

/// The unit normal of a triangle's plane in the render frame, by its winding in its own frame.
pub(super) fn geometric_normal([a, b, c]: [DVec3; 3], placed: &Placed) -> DVec3 {
    placed.normal_to_render((b - a).cross(c - a)).unwrap_or(DVec3::Z)
}

/// The interpolated normal, unit, on the side of `geometric`; `geometric` itself where there is none.
pub(super) fn shading_normal(
    mesh: &Mesh,
    triangle: [u32; 3],
    weights: [f64; 3],
    placed: &Placed,
    geometric: DVec3,
) -> DVec3 {
    if mesh.normals().is_empty() {
        return geometric;
    }
    let normals = triangle.map(|v| mesh.normals()[v as usize].as_dvec3());
    let Some(normal) = placed.normal_to_render(blend(normals, weights)) else { return geometric };
    if normal.dot(geometric) < 0.0 { -normal } else { normal }
}

fn blend(values: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2]
}

fn uv(mesh: &Mesh, triangle: [u32; 3], weights: [f64; 3]) -> Vec2 {
    if mesh.uvs().is_empty() {
        return Vec2::ZERO;
    }
    let [a, b, c] = triangle.map(|v| mesh.uvs()[v as usize].as_dvec2());
    (a * weights[0] + b * weights[1] + c * weights[2]).as_vec2()
}

/// Root of the ratio of a triangle's areas in texture units and in the render frame.
fn uv_per_m(mesh: &Mesh, triangle: [u32; 3], corners: [DVec3; 3], placed: &Placed) -> f32 {
    if mesh.uvs().is_empty() {
        return 0.0;
    }
    let [a, b, c]: [DVec2; 3] = triangle.map(|v| mesh.uvs()[v as usize].as_dvec2());
    let texture = (b - a).perp_dot(c - a).abs();
    let [a, b, c] = corners.map(|p| placed.point_to_render(p));
    (texture / (b - a).cross(c - a).length()).sqrt() as f32
}
