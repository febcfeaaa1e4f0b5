//! Shapes placed in the world, and relative to the camera at one moment.

use etendue_core::{Motion, Ray, maths};
use glam::{DAffine3, DMat3, DVec3, Mat3, Vec3};

use super::Mesh;
use crate::MaterialId;

/// Index of a mesh in the world's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(pub u32);

/// Shape of an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A triangle mesh.
    Mesh(MeshId),
    /// A sphere about the origin of its own frame.
    Sphere {
        /// Radius in its own frame, m.
        radius_m: f64,
    },
}

/// A shape placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    pub shape: Shape,
    /// Transform from the shape's own frame to the world.
    pub to_world: Motion,
    /// The material of each slot of the shape; a sphere has one slot.
    pub materials: Vec<MaterialId>,
    /// Identity of the object in ground truth; 0 is the background.
    pub instance_id: u32,
    /// Class of the object in ground truth; 0 is the background.
    pub semantic_id: u32,
}

/// An instance's transforms between its own frame and the render frame, in f64.
#[derive(Clone, Debug)]
pub(crate) struct InstanceTransform {
    to_render: DAffine3,
    to_local: DAffine3,
    /// Transforms normals to the render frame, up to their length.
    normals: Mat3,
    /// True if it preserves their length.
    keeps_length: bool,
    mean_scale: f64,
    /// True if the instance is only translated, neither rotated nor scaled.
    is_shifted: bool,
    /// For an instance whose triangle corners are rounded in the render frame: their maximum coordinates by axis, m.
    merged: Option<DVec3>,
}

impl InstanceTransform {
    /// Places an instance relative to a camera at `origin_m`.
    pub(crate) fn new(to_world: DAffine3, origin_m: DVec3) -> Self {
        let (to_render, to_local) = about(to_world, origin_m);
        let scale = uniform_scale(&to_render.matrix3);
        // Not by the matrix itself: for very large and very small instances f32 could not hold it.
        let turned = to_local.matrix3.transpose();
        let largest = turned.to_cols_array().into_iter().fold(f64::MIN_POSITIVE, |maximum, x| maximum.max(x.abs()));
        Self {
            to_render,
            to_local,
            normals: (turned * scale.unwrap_or(1.0 / largest)).as_mat3(),
            keeps_length: scale.is_some(),
            is_shifted: to_render.matrix3 == DMat3::IDENTITY,
            mean_scale: maths::f64::cbrt(to_render.matrix3.determinant().abs()),
            merged: None,
        }
    }

    /// Records that the corners of its triangles, with coordinates up to `greatest` (by axis, m), are rounded to f32 in the render frame,
    /// where rays then hit them.
    pub(crate) fn merge(&mut self, maximum: DVec3) {
        self.merged = Some(maximum);
    }

    /// True if the corners of its triangles are rounded in the render frame.
    pub(crate) fn is_merged(&self) -> bool {
        self.merged.is_some()
    }

    /// A point of the instance's frame, in the render frame.
    pub(crate) fn point_to_render(&self, point: DVec3) -> DVec3 {
        self.to_render.transform_point3(point)
    }

    /// A vector of the instance's frame, in the render frame.
    pub(crate) fn vector_to_render(&self, vector: DVec3) -> DVec3 {
        self.to_render.transform_vector3(vector)
    }

    /// A vector of the render frame, in the instance's.
    pub(crate) fn vector_to_local(&self, vector: DVec3) -> DVec3 {
        self.to_local.transform_vector3(vector)
    }

    /// A ray's origin and direction in the instance's frame. The direction keeps its stretch, so t keeps its meaning.
    #[inline]
    pub(crate) fn ray_to_local(&self, ray: &Ray) -> (DVec3, DVec3) {
        self.line_to_local(ray.origin.as_dvec3(), ray.direction.as_dvec3())
    }

    /// As [`InstanceTransform::ray_to_local`], rounded to f32; fast if the instance is only translated.
    #[inline(always)]
    pub(crate) fn rounded_ray_to_local(&self, ray: &Ray) -> (Vec3, Vec3) {
        if self.is_shifted {
            return ((ray.origin.as_dvec3() + self.to_local.translation).as_vec3(), ray.direction);
        }
        let (origin, direction) = self.ray_to_local(ray);
        (origin.as_vec3(), direction.as_vec3())
    }

    /// As [`InstanceTransform::ray_to_local`], in f64.
    #[inline]
    pub(crate) fn line_to_local(&self, origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        (self.to_local.transform_point3(origin), self.to_local.transform_vector3(direction))
    }

    /// A unit normal of the instance's frame, in the render frame: unit, and on the same side of its surface. `None` if it has no
    /// direction.
    pub(crate) fn normal_to_render(&self, normal: DVec3) -> Option<DVec3> {
        (self.to_local.matrix3.transpose() * normal).try_normalize()
    }

    /// A unit normal of the instance's frame, in the render frame: unit, to some roundings of f32.
    pub(crate) fn unit_normal_to_render(&self, normal: Vec3) -> Vec3 {
        let turned = self.normals * normal;
        if self.keeps_length { turned } else { turned.normalize_or(Vec3::Z) }
    }

    /// A normal of the instance's frame, of any length, in the render frame: unit, to some roundings of f32.
    pub(crate) fn long_normal_to_render(&self, normal: Vec3) -> Vec3 {
        self.normals * normal
    }

    /// True if the instance turns right-handed shapes into left-handed ones.
    pub(crate) fn mirrors(&self) -> bool {
        self.to_render.matrix3.determinant() < 0.0
    }

    /// Scale of the instance, if it is the same in all directions.
    pub(crate) fn uniform_scale(&self) -> Option<f64> {
        uniform_scale(&self.to_render.matrix3)
    }

    /// Mean scale of the instance: the third root of its scale of volumes.
    pub(crate) fn mean_scale(&self) -> f64 {
        self.mean_scale
    }

    /// Minimum and maximum coordinates in the render frame, m, of the instance's shape among the world's `meshes`; `None` for a mesh
    /// without triangles.
    pub(crate) fn bounds(&self, instance: &Instance, meshes: &[Mesh]) -> Option<(DVec3, DVec3)> {
        let (low, high) = match instance.shape {
            Shape::Mesh(id) => meshes[id.0 as usize].bounds().map(|(low, high)| (low.as_dvec3(), high.as_dvec3()))?,
            Shape::Sphere { radius_m } => return Some(self.sphere_bounds(radius_m)),
        };
        let half = self.abs_matrix() * ((high - low) * 0.5);
        let centre = self.point_to_render((low + high) * 0.5);
        Some((centre - half, centre + half))
    }

    fn sphere_bounds(&self, radius_m: f64) -> (DVec3, DVec3) {
        let rows = self.to_render.matrix3.transpose();
        let half = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length()) * radius_m;
        (self.to_render.translation - half, self.to_render.translation + half)
    }

    /// The maximum coordinate, in the instance's frame, of a box of the render frame.
    pub(crate) fn max_local_coordinate(&self, low: DVec3, high: DVec3) -> f64 {
        let corner = |i: u32| DVec3::select(glam::BVec3::new(i & 1 == 0, i & 2 == 0, i & 4 == 0), low, high);
        let local = (0..8).map(|i| self.to_local.transform_point3(corner(i)).abs().max_element());
        local.fold(0.0, |maximum: f64, x| if x > maximum || x.is_nan() { x } else { maximum })
    }

    /// Maximum distance, per axis of the render frame (m), by which rounding may move a surface point or a ray's origin computed from it
    /// off the surface. The point and the pushed origin are each rounded to f32 in the render frame (half a unit in the last place each, ≤
    /// 2⁻²⁴ of the coordinate), and the origin once more in the instance's frame. The factors 3 and 2 instead of 2 and 1 leave a margin for
    /// the push itself and for the f64 arithmetic, which is 2²⁹ times finer. For a merged instance the corners are rounded instead of the
    /// origin, and with them all points between.
    #[inline]
    pub(crate) fn position_error(&self, position: Vec3, local: DVec3) -> Vec3 {
        let carried = self.merged.unwrap_or_else(|| self.abs_matrix() * local.abs());
        (position.as_dvec3().abs() * (3.0 * HALF_ULP) + carried * (2.0 * HALF_ULP)).as_vec3()
            + Vec3::splat(f32::MIN_POSITIVE)
    }

    fn abs_matrix(&self) -> DMat3 {
        let m = self.to_render.matrix3;
        DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
    }
}

/// Transform to the render frame of a camera at `origin_m`, and its inverse.
pub(super) fn about(mut to_world: DAffine3, origin_m: DVec3) -> (DAffine3, DAffine3) {
    to_world.translation -= origin_m;
    (to_world, to_world.inverse())
}

pub(crate) fn uniform_scale(m: &DMat3) -> Option<f64> {
    let square = m.x_axis.length_squared();
    // M Mᵀ is a multiple of the identity; descriptions are written with some ten digits.
    let gram = m.transpose() * *m;
    let deviation = (gram - DMat3::from_diagonal(DVec3::splat(square))).to_cols_array();
    deviation.iter().all(|x| x.abs() <= 1e-9 * square).then_some(square.sqrt())
}

/// Maximum relative error of rounding to f32: 2⁻²⁴.
const HALF_ULP: f64 = 5.960_464_477_539_063e-8;
