//! From a hit to the point of the surface, and the scales of textures and shapes there.
//!
//! Positions are computed from the primitive, not from the ray: a triangle's from barycentric coordinates, a sphere's by projecting the ray's point
//! back onto the sphere, both in f64. Their error is then that of rounding to f32, whatever the length of the ray (after Wächter & Binder 2019, "A
//! fast and robust method for avoiding self-intersection").

use core::f64::consts::{PI, TAU};

use etendue_core::Ray;
use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::geometry::{Footprint, Hit, Instance, InstanceTransform, MeshPose, SurfacePoint, sphere};

pub(super) fn mesh_footprint(mesh: &MeshPose<'_>, placed: &InstanceTransform, primitive: u32) -> Footprint {
    Footprint { uv_per_m: uv_per_m(mesh, placed, primitive), local_per_m: local_per_m(placed) }
}

pub(super) fn sphere_footprint(radius_m: f64, placed: &InstanceTransform) -> Footprint {
    let uv_per_m = sphere::uv_per_m(radius_m * placed.mean_scale()) as f32;
    Footprint { uv_per_m, local_per_m: local_per_m(placed) }
}

/// Change of texture coordinates along a vector of a mesh's own frame in the plane of a triangle.
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

/// Change of longitude (turns) and latitude (half turns) along a vector at a point of a sphere about the origin; zero at the poles.
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

#[inline(always)]
pub(super) fn mesh_point(
    mesh: &MeshPose<'_>,
    instance: &Instance,
    placed: &InstanceTransform,
    ray: &Ray,
    hit: &Hit,
) -> SurfacePoint {
    let weights = weights(f64::from(hit.u), f64::from(hit.v));
    let local = blend(mesh.corners(hit.primitive).map(Vec3::as_dvec3), weights);
    let position = placed.point_to_render(local).as_vec3();
    let facet = mesh.facet(hit.primitive);
    let flat = placed.unit_normal_to_render(facet.normal);
    let normals = if facet.is_flat { None } else { mesh.normals(hit.primitive) };
    let (shading, own) = match normals {
        None => (flat, facet.normal),
        Some(normals) => interpolated_normals(mesh, hit.primitive, normals, weights, placed, flat),
    };
    SurfacePoint {
        position,
        position_error: placed.position_error(position, local),
        geometric_normal: flat,
        shading_normal: shading,
        uv: uv(mesh, hit.primitive, weights),
        local: local.as_vec3(),
        local_normal: own,
        instance: hit.instance,
        primitive: hit.primitive,
        time_s: ray.time_s,
        material: instance.materials[usize::from(facet.slot)],
    }
}

/// The interpolated normal in the render frame, on the side of the triangle's own, `flat`, and in the mesh's frame; unit. In f32, except
/// for lengths whose squares f32 cannot hold.
fn interpolated_normals(
    mesh: &MeshPose<'_>,
    primitive: u32,
    [a, b, c]: [Vec3; 3],
    weights: [f64; 3],
    placed: &InstanceTransform,
    flat: Vec3,
) -> (Vec3, Vec3) {
    let [wa, wb, wc] = weights.map(|w| w as f32);
    let own = a * wa + b * wb + c * wc;
    let normal = placed.long_normal_to_render(own);
    let squares = [own.length_squared(), normal.length_squared()];
    if !squares.iter().all(|square| RELIABLE_LENGTH2.contains(square)) {
        let normals = Normals::from_mesh(mesh, primitive, weights, placed);
        return (normals.shading.as_vec3(), normals.local.normalize_or(DVec3::Z).as_vec3());
    }
    let side = 1.0_f32.copysign(normal.dot(flat));
    (normal * (side / squares[1].sqrt()), own * (1.0 / squares[0].sqrt()))
}

/// Range of squared lengths that f32 holds to all digits, and that are no remainders of cancelling normals.
const RELIABLE_LENGTH2: core::ops::RangeInclusive<f32> = 1e-6..=1e20;

pub(super) fn sphere_point(
    radius_m: f64,
    instance: &Instance,
    placed: &InstanceTransform,
    ray: &Ray,
    hit: &Hit,
) -> SurfacePoint {
    let (origin, direction) = placed.ray_to_local(ray);
    let unit = (origin + direction * f64::from(hit.t)).try_normalize().unwrap_or(DVec3::Z);
    let local = unit * radius_m;
    let position = placed.point_to_render(local).as_vec3();
    let normal = placed.normal_to_render(unit).unwrap_or(DVec3::Z).as_vec3();
    SurfacePoint {
        position,
        position_error: placed.position_error(position, local),
        geometric_normal: normal,
        shading_normal: normal,
        uv: sphere::uv(unit).as_vec2(),
        local: local.as_vec3(),
        local_normal: unit.as_vec3(),
        instance: hit.instance,
        primitive: hit.primitive,
        time_s: ray.time_s,
        material: instance.materials[0],
    }
}

/// Weights of a triangle's three vertices.
pub(super) fn weights(u: f64, v: f64) -> [f64; 3] {
    [1.0 - u - v, u, v]
}

/// Normals at a point of a mesh, in f64.
pub(super) struct Normals {
    /// Normal of the triangle's plane in the render frame, by its winding in its own frame; unit.
    geometric: DVec3,
    /// Interpolated normal in the render frame, on the side of the geometric one, which replaces it if there is none; unit.
    pub(super) shading: DVec3,
    /// Shading normal in the mesh's own frame, of any length.
    local: DVec3,
}

impl Normals {
    pub(super) fn from_mesh(
        mesh: &MeshPose<'_>,
        primitive: u32,
        weights: [f64; 3],
        placed: &InstanceTransform,
    ) -> Self {
        let [a, b, c] = mesh.corners(primitive).map(Vec3::as_dvec3);
        let local = (b - a).cross(c - a);
        let geometric = placed.normal_to_render(local).unwrap_or(DVec3::Z);
        let flat = Self { geometric, shading: geometric, local };
        flat.interpolated(mesh, primitive, weights, placed).unwrap_or(flat)
    }

    fn interpolated(
        &self,
        mesh: &MeshPose<'_>,
        primitive: u32,
        weights: [f64; 3],
        placed: &InstanceTransform,
    ) -> Option<Self> {
        let normals = mesh.normals(primitive)?.map(Vec3::as_dvec3);
        let local = blend(normals, weights);
        let normal = placed.normal_to_render(local)?;
        let shading = if normal.dot(self.geometric) < 0.0 { -normal } else { normal };
        Some(Self { geometric: self.geometric, shading, local })
    }
}

fn blend(values: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2]
}

fn uv(mesh: &MeshPose<'_>, primitive: u32, weights: [f64; 3]) -> Vec2 {
    let Some(uvs) = mesh.uvs(primitive) else { return Vec2::ZERO };
    let [a, b, c] = uvs.map(|uv| uv.as_dvec2());
    (a * weights[0] + b * weights[1] + c * weights[2]).as_vec2()
}
