//! Ground truth along a ray.
//!
//! The accelerator, which works in f32, returns the primitive; distance, position and normal are then solved again in f64 against that primitive: a
//! plane through the triangle's corners, or a sphere. The error is that of f64 at every incidence, not that of f32 over the cosine.
//!
//! The accelerator's ray is the exact one rounded to f32, some 1e-7 of the distance off it. At a silhouette the exact ray may therefore miss the
//! returned triangle. If that is small, far away or nearly edge-on, the intersection with its plane may be anywhere. A plane is accepted up to 1e-3
//! of the triangle beyond its edges (the least barycentric weight is −1e-3 or more). Beyond that, the result is that of the accelerator's ray, solved
//! in f64: a point of the triangle's edge.

use etendue_core::Ray;
use glam::{DVec3, Vec3};

use super::point::{self, Normals};
use super::{Hit, RenderSpace};
use crate::geometry::{InstanceTransform, MeshPose, Shape, SurfacePoint, sphere};

/// Maximum distance beyond its triangle, in barycentric weights, at which a plane is accepted.
const MAX_BARYCENTRIC_EXCESS: f64 = 1e-3;

/// Origin and direction in a mesh's frame, and the distance along the exact ray at which the line begins, m.
type TruthLine = (DVec3, DVec3, f64);

/// First hit of a ray, exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Distance from the ray's origin, m.
    pub distance_m: f64,
    /// The point hit, in the world, m.
    pub position_m: DVec3,
    /// Unit shading normal in the world, on the side of the surface's winding (outwards for spheres).
    pub normal: DVec3,
    /// Index of the instance in the world's list.
    pub instance: u32,
    /// Primitive within the instance's shape.
    pub primitive: u32,
    /// The instance's identity.
    pub instance_id: u32,
    /// The instance's class.
    pub semantic_id: u32,
    /// Index of the material.
    pub material: u32,
}

/// Maximum number of passed surfaces; the next one is accepted in any case. Rays move from one to the next by the minimum step; among
/// surfaces closer together than that they might loop.
const MAX_PASSES: usize = 4096;

impl RenderSpace<'_> {
    /// The first hit of the ray from `origin_m` (render frame, m) along `direction` (any length) that `accept` accepts, at `time_s` (as
    /// [`Ray::time_s`]); the ray passes straight through other points. `None` for the background.
    #[must_use]
    pub fn truth(
        &self,
        origin_m: DVec3,
        direction: DVec3,
        time_s: f32,
        accept: impl Fn(&SurfacePoint) -> bool,
    ) -> Option<Truth> {
        let direction = direction.try_normalize()?;
        let mut rounded = Ray::new(origin_m.as_vec3(), direction.as_vec3(), time_s);
        let mut hit = self.closest(&rounded)?;
        for _ in 0..MAX_PASSES {
            let point = self.surface(&rounded, &hit);
            if accept(&point) {
                break;
            }
            rounded.origin = point.spawn(rounded.direction);
            hit = self.closest(&rounded)?;
        }
        Some(self.solve(origin_m, direction, &rounded, &hit))
    }

    /// The exact ray from `origin_m` along `direction` (unit) against the primitive that `rounded` has hit.
    fn solve(&self, origin_m: DVec3, direction: DVec3, rounded: &Ray, hit: &Hit) -> Truth {
        let instance = &self.world.instances()[hit.instance as usize];
        let placed = &*self.placed_at(hit.instance, rounded.time_s);
        let (origin, along) = placed.line_to_local(origin_m, direction);
        // Start of the rounded ray, along the exact one.
        let passed = rounded.origin != origin_m.as_vec3();
        let start = if passed { (rounded.origin.as_dvec3() - origin_m).dot(direction) } else { 0.0 };
        let (t, normal, slot) = match instance.shape {
            Shape::Mesh(id) => {
                let lines = [(origin, along, 0.0), traced(placed, rounded, start)];
                on_mesh(&self.pose(id, rounded.time_s), placed, hit, lines)
            }
            Shape::Sphere { radius_m } => {
                let about = passed.then_some(start + f64::from(hit.t));
                on_sphere(radius_m, placed, origin, along, about)
            }
        };
        let position_m = self.origin_m + origin_m + direction * t;
        Truth {
            distance_m: t,
            position_m,
            normal,
            instance: hit.instance,
            primitive: hit.primitive,
            instance_id: instance.instance_id,
            semantic_id: instance.semantic_id,
            material: instance.materials[slot].0,
        }
    }
}

/// The accelerator's line in a mesh's frame, which begins at `start`.
fn traced(placed: &InstanceTransform, rounded: &Ray, start: f64) -> TruthLine {
    let (origin, direction) = placed.ray_to_local(rounded);
    (origin.as_vec3().as_dvec3(), direction.as_vec3().as_dvec3(), start)
}

/// The hit of the first of `lines` that hits the triangle.
fn on_mesh(mesh: &MeshPose<'_>, placed: &InstanceTransform, hit: &Hit, lines: [TruthLine; 2]) -> (f64, DVec3, usize) {
    let corners = mesh.corners(hit.primitive).map(Vec3::as_dvec3);
    let meets = |(t, u, v): &(f64, f64, f64)| *t > 0.0 && u.min(*v).min(1.0 - u - v) >= -MAX_BARYCENTRIC_EXCESS;
    let solve = |(origin, along, start): TruthLine| {
        plane(corners, origin, along).filter(meets).map(|(t, u, v)| (start + t, u, v))
    };
    let solved = lines.into_iter().find_map(solve);
    // A ray in the plane itself has no better result than the accelerator's.
    let (t, u, v) = solved.unwrap_or((lines[1].2 + f64::from(hit.t), f64::from(hit.u), f64::from(hit.v)));
    let normals = Normals::from_mesh(mesh, hit.primitive, point::weights(u, v), placed);
    (t, normals.shading, usize::from(mesh.mesh().slots()[hit.primitive as usize]))
}

/// Intersection of a ray with a triangle's plane: t, and the barycentric weights of vertices 1 and 2 there.
pub(super) fn plane([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, f64, f64)> {
    let (along, across) = (b - a, c - a);
    let normal = along.cross(across);
    let t = normal.dot(a - origin) / normal.dot(direction);
    let inside = origin + direction * t - a;
    let square = normal.length_squared();
    let (u, v) = (normal.dot(inside.cross(across)) / square, normal.dot(along.cross(inside)) / square);
    (t.is_finite() && u.is_finite() && v.is_finite()).then_some((t, u, v))
}

/// Intersection of a line with a sphere: for a ray that has passed other points, the root nearest to the accelerator's.
fn on_sphere(
    radius_m: f64,
    placed: &InstanceTransform,
    origin: DVec3,
    direction: DVec3,
    passed_to: Option<f64>,
) -> (f64, DVec3, usize) {
    // A ray that hits the sphere only after rounding to f32: the point of closest approach.
    let abreast = -origin.dot(direction) / direction.length_squared();
    let t = match (sphere::roots(radius_m, origin, direction), passed_to) {
        (Some([near, far]), Some(about)) if (far - about).abs() < (near - about).abs() => far,
        (Some([near, _]), Some(_)) => near,
        (roots, _) => roots.into_iter().flatten().find(|t| *t > 0.0).unwrap_or(abreast),
    };
    let unit = (origin + direction * t).try_normalize().unwrap_or(DVec3::Z);
    let normal = placed.normal_to_render(unit).unwrap_or(DVec3::Z);
    (t, normal, 0)
}
