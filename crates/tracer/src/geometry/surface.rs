//! Hits of rays, points on surfaces, and rays that leave them.

use etendue_core::{PrimitiveId, Ray};
use glam::{Vec2, Vec3};

use crate::MaterialId;

/// A point of a surface, in the render frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, m.
    pub position: Vec3,
    /// Maximum distance of the stored point, and of a ray's origin computed from it, from the true surface, per axis, m.
    pub position_error: Vec3,
    /// Unit normal of the surface itself: by the winding of a mesh's triangles in their own frame (anticlockwise seen
    /// from its tip), outwards for spheres.
    pub geometric_normal: Vec3,
    /// Unit normal for shading: the vertices' normals interpolated, on the same side as the geometric one.
    pub shading_normal: Vec3,
    /// Texture coordinates; zero if the mesh has none.
    pub uv: Vec2,
    /// The point in the own frame of the shape, in its units, minus the mesh's [`super::Mesh::origin`].
    pub local: Vec3,
    /// The normal for shading in the own frame of the shape; unit, on either side.
    pub local_normal: Vec3,
    /// Index of the instance in the world.
    pub instance: u32,
    /// Primitive within the instance's shape.
    pub primitive: u32,
    /// Time of the point: that of the ray that hit it, s ([`etendue_core::Ray::time_s`]).
    pub time_s: f32,
    /// The material here.
    pub material: MaterialId,
}

/// Scales of texture and shape at a point of a surface, for filtering textures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Texture units per metre of the surface; 0 without texture coordinates.
    pub uv_per_m: f32,
    /// Units of the shape's own frame per metre, on average over all directions.
    pub local_per_m: f32,
}

impl SurfacePoint {
    /// An origin for a ray that leaves the surface along `direction`: the point, pushed off the surface along its normal, to the side of
    /// `direction`, by the error bound. The surface's own plane then lies behind the ray (Pharr, Jakob, Humphreys 2023, section 6.8.6).
    #[must_use]
    pub fn spawn(&self, direction: Vec3) -> Vec3 {
        let normal = self.geometric_normal;
        let distance = normal.abs().dot(self.position_error);
        let side = if normal.dot(direction) < 0.0 { -distance } else { distance };
        self.position + normal * side
    }

    /// The primitive that the point lies on.
    #[must_use]
    pub fn primitive_id(&self) -> PrimitiveId {
        PrimitiveId { instance: self.instance, primitive: self.primitive }
    }

    /// A ray without end that leaves the surface along `direction`, from [`SurfacePoint::spawn`], at the point's time.
    #[must_use]
    pub fn leave(&self, direction: Vec3) -> Ray {
        Ray::new(self.spawn(direction), direction, self.time_s).leaving(self.primitive_id())
    }
}

/// First hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in lengths of the ray's direction.
    pub t: f32,
    /// Index of the instance in the world.
    pub instance: u32,
    /// Primitive within the instance's shape: the triangle, or 0 for a sphere.
    pub primitive: u32,
    /// Barycentric weight of the triangle's vertex 1.
    pub u: f32,
    /// Barycentric weight of the triangle's vertex 2.
    pub v: f32,
}
