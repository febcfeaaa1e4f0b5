//! The world relative to one camera.
//!
//! A [`RenderSpace`] places every instance relative to the camera's entrance pupil in f64 and only then converts to f32, so that precision is best
//! near the camera wherever in the world it is. The same holds for times: rays count theirs from the start of the view's interval. Moving objects are
//! evaluated at a ray's own time. Rays and results are in the render frame (axes of the world, origin at the entrance pupil, m). No part of a mesh is
//! rebuilt except the trees of those whose vertices move.

mod point;
mod truth;

use std::borrow::Cow;

use etendue_core::{Ray, TimeInterval};
use glam::{DVec3, Vec2, Vec3};

use crate::accel::{Simd, Visits, World};
use crate::geometry::{Footprint, Hit, InstanceTransform, MeshId, MeshPose, Placement, Shape, SurfacePoint};
use crate::{accel::tlas::Tlas, is_optional};

pub use truth::Truth;

impl World {
    /// The world placed relative to a camera whose entrance pupil is at `origin_m` (world, m), at the time 0.
    #[must_use]
    pub fn render_space(&self, origin_m: DVec3) -> RenderSpace<'_> {
        self.render_space_with(origin_m, TimeInterval::default(), Simd::Auto)
    }

    /// As [`World::render_space`], during an interval of time and with a choice of instruction set. The rays of the view have times in that
    /// interval, which count from its start; a ray of a time outside sees the world at the nearer end.
    #[must_use]
    pub fn render_space_with(&self, origin_m: DVec3, interval: TimeInterval, simd: Simd) -> RenderSpace<'_> {
        let placed = self.placed(origin_m, interval);
        RenderSpace { world: self, origin_m, interval, top: Tlas::with_merging(self, placed, interval, simd) }
    }

    /// As [`World::render_space_with`], built faster but slower to trace, for few rays: no instance is merged.
    #[must_use]
    pub fn render_space_for_few(&self, origin_m: DVec3, interval: TimeInterval) -> RenderSpace<'_> {
        let placed = self.placed(origin_m, interval);
        RenderSpace { world: self, origin_m, interval, top: Tlas::new(self, placed, None, interval, Simd::Auto) }
    }

    fn placed(&self, origin_m: DVec3, interval: TimeInterval) -> Vec<Placement> {
        self.instances().iter().map(|i| Placement::new(i, origin_m, interval)).collect()
    }
}

/// A world placed relative to a camera during an interval of time, ready for ray queries.
#[derive(Clone, Debug)]
pub struct RenderSpace<'w> {
    world: &'w World,
    origin_m: DVec3,
    interval: TimeInterval,
    top: Tlas<'w>,
}

impl<'w> RenderSpace<'w> {
    /// The world of the view.
    #[must_use]
    pub fn world(&self) -> &'w World {
        self.world
    }

    /// The camera's entrance pupil in the world, m: the origin of the render frame.
    #[must_use]
    pub fn origin_m(&self) -> DVec3 {
        self.origin_m
    }

    /// The view's interval of time; rays' times count from its start.
    #[must_use]
    pub fn interval(&self) -> TimeInterval {
        self.interval
    }

    /// The first surface that a ray hits, with t > 0 and t < `ray.t_max`. Surfaces are hit from both sides. Of several at the same t, the
    /// one of the least instance, then the least primitive.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.top.closest(ray)
    }

    /// True if a ray hits anything, with t > 0 and t < `ray.t_max`.
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.top.occluded(ray)
    }

    /// Counts the visits of `ray` in the accelerator until its first hit, or any hit, is found; for benchmarks of trees. Slower than the
    /// query itself.
    #[must_use]
    pub fn visits(&self, ray: &Ray, any: bool) -> Visits {
        self.top.visits(ray, any)
    }

    /// The point of the surface that `ray` hit at `hit`.
    #[must_use]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let instance = &self.world.instances()[hit.instance as usize];
        if let (Shape::Mesh(id), Some(placed)) = (instance.shape, self.placed(hit.instance).static_transform())
            && let mesh = self.world.mesh(id)
            && mesh.animation().is_none()
        {
            return point::mesh_point(&MeshPose::from_mesh(mesh), instance, placed, ray, hit);
        }
        is_optional();
        self.surface_of_other(ray, hit)
    }

    /// The same for moving instances and for spheres.
    #[cold]
    #[inline(never)]
    fn surface_of_other(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let instance = &self.world.instances()[hit.instance as usize];
        let placed = &*self.placed_at(hit.instance, ray.time_s);
        match instance.shape {
            Shape::Mesh(id) => point::mesh_point(&self.pose(id, ray.time_s), instance, placed, ray, hit),
            Shape::Sphere { radius_m } => point::sphere_point(radius_m, instance, placed, ray, hit),
        }
    }

    /// Scales of texture and shape at a point of this view's surfaces.
    #[must_use]
    pub fn footprint(&self, point: &SurfacePoint) -> Footprint {
        let placed = &*self.placed_at(point.instance, point.time_s);
        match self.world.instances()[point.instance as usize].shape {
            Shape::Mesh(id) => point::mesh_footprint(&self.pose(id, point.time_s), placed, point.primitive),
            Shape::Sphere { radius_m } => point::sphere_footprint(radius_m, placed),
        }
    }

    /// The offset from [`SurfacePoint::local`] of an instance's points to the coordinates of its shape's file.
    #[must_use]
    pub fn local_origin(&self, instance: u32) -> DVec3 {
        match self.world.instances()[instance as usize].shape {
            Shape::Mesh(id) => self.world.mesh(id).origin(),
            Shape::Sphere { .. } => DVec3::ZERO,
        }
    }

    /// Change of texture coordinates and of the position in the own frame of the shape along a `vector` (render frame, m) in the surface at
    /// a point.
    #[must_use]
    pub fn change_along(&self, point: &SurfacePoint, vector: Vec3) -> (Vec2, Vec3) {
        let local = self.placed_at(point.instance, point.time_s).vector_to_local(vector.as_dvec3());
        let uv = match self.world.instances()[point.instance as usize].shape {
            Shape::Mesh(id) => point::uv_along(&self.pose(id, point.time_s), point.primitive, local),
            Shape::Sphere { .. } => point::globe_along(point.local.as_dvec3(), local),
        };
        (uv.as_vec2(), local.as_vec3())
    }

    /// The directions in which the two texture coordinates increase at a point of this view's surfaces, in its plane: unit, in the render
    /// frame, neither perpendicular to each other nor to the shading normal. `None` if there are none: without texture coordinates, if they
    /// do not span the triangle, at the poles of a sphere.
    #[must_use]
    pub fn tangents(&self, point: &SurfacePoint) -> Option<[Vec3; 2]> {
        let placed = &*self.placed_at(point.instance, point.time_s);
        let local = match self.world.instances()[point.instance as usize].shape {
            Shape::Mesh(id) => point::mesh_tangents(&self.pose(id, point.time_s), point.primitive)?,
            Shape::Sphere { .. } => point::sphere_tangents(point.local.as_dvec3())?,
        };
        point::tangents_to_render(local, placed)
    }

    pub(crate) fn placed(&self, instance: u32) -> &Placement {
        &self.top.placed()[instance as usize]
    }

    /// An instance's transforms at a ray's time.
    fn placed_at(&self, instance: u32, time_s: f32) -> Cow<'_, InstanceTransform> {
        self.placed(instance).at(time_s)
    }

    /// A mesh at a ray's time.
    #[inline(always)]
    fn pose(&self, id: MeshId, time_s: f32) -> MeshPose<'_> {
        let mesh = self.world.mesh(id);
        if mesh.animation().is_none() { MeshPose::from_mesh(mesh) } else { mesh.at(self.interval.moment(time_s)) }
    }

    /// Primitives of an instance: its triangles, or 1 for a sphere.
    #[must_use]
    pub fn primitive_count(&self, instance: u32) -> u32 {
        match self.world.instances()[instance as usize].shape {
            Shape::Mesh(id) => self.world.mesh(id).triangles().len() as u32,
            Shape::Sphere { .. } => 1,
        }
    }

    /// The corners of a triangle in the render frame at a ray's time, m, anticlockwise about its geometric normal: in the mesh's order, but
    /// vertices 1 and 2 exchanged in an instance that mirrors. Panics if the instance is a sphere.
    #[must_use]
    pub fn triangle(&self, instance: u32, primitive: u32, time_s: f32) -> [Vec3; 3] {
        let Shape::Mesh(id) = self.world.instances()[instance as usize].shape else {
            panic!("instance {instance} is a sphere and has no triangles");
        };
        let placed = self.placed_at(instance, time_s);
        let [a, b, c] =
            self.pose(id, time_s).corners(primitive).map(|p| placed.point_to_render(p.as_dvec3()).as_vec3());
        if placed.mirrors() { [a, c, b] } else { [a, b, c] }
    }

    /// Centre (render frame, m) and radius (m) of an instance that is a sphere there too, at a ray's time; `None` for meshes and for
    /// spheres that their instance stretches non-uniformly.
    #[must_use]
    pub fn sphere(&self, instance: u32, time_s: f32) -> Option<(Vec3, f32)> {
        let Shape::Sphere { radius_m } = self.world.instances()[instance as usize].shape else { return None };
        let placed = self.placed_at(instance, time_s);
        let scale = placed.uniform_scale()?;
        Some((placed.point_to_render(DVec3::ZERO).as_vec3(), (radius_m * scale) as f32))
    }

    /// Centre (render frame, m) and radius (m) of a sphere about all instances during the interval; both zero in an empty world.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, f32) {
        let boxes = self.top.placed().iter().zip(self.world.instances());
        let boxes = boxes.filter_map(|(placed, instance)| placed.bounds(instance, self.world.meshes()));
        let Some((low, high)) = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
            return (Vec3::ZERO, 0.0);
        };
        // Margin for the rounding of centre and radius.
        (((low + high) * 0.5).as_vec3(), ((high - low).length() * 0.5 * (1.0 + 1e-6)) as f32)
    }
}

#[cfg(test)]
mod tests {
    mod motion;
    mod spawn;
    mod surface;
    mod truth;
}
