//! Emitting spheres, and ellipsoids (spheres under unequal scales).
//!
//! From outside, a round sphere is sampled by solid angle, uniformly over its cone. It is sampled uniformly over the sphere in its own frame from
//! inside, for an ellipsoid, and if light passes through the surface, so that the far side is seen too. The density by area is then 1/(4π J) with the
//! stretch of area J = |det M| · |M⁻ᵀ n|. M transforms the unit sphere to the render frame and n is the unit sphere's normal.

use core::f32::consts::{PI, TAU};

use etendue_core::Basis;
use etendue_core::warp::{uniform_cone, uniform_sphere};
use glam::{DAffine3, DMat3, DVec3, Mat3, Vec2, Vec3};

use super::{LightHit, ROUNDING, SurfaceEmission, SurfaceSample, solid_angle_pdf, tree::LightBounds};
use crate::{MaterialId, geometry::sphere, materials::MaterialTable};

/// An emitting sphere in the render frame.
#[derive(Clone, Debug)]
pub(super) struct SphereLight {
    centre: Vec3,
    /// M.
    linear: Mat3,
    /// M⁻ᵀ.
    normals: Mat3,
    determinant: f32,
    /// Radius, m, if the sphere is round and nothing passes through it.
    radius: Option<f32>,
    area_m2: f64,
    error_m: f32,
    material: MaterialId,
    /// True if texture coordinates are needed.
    textured: bool,
}

/// Properties of a sphere's material that determine its sampling.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereSurface {
    /// True if light passes through its surface.
    lets_pass: bool,
    /// True if texture coordinates are needed.
    textured: bool,
}

impl SphereSurface {
    pub(super) fn new(material: MaterialId, material_table: &MaterialTable) -> Self {
        Self { lets_pass: material_table.lets_pass(material), textured: material_table.needs_footprint(material) }
    }
}

/// The cone that a round sphere covers, seen from outside.
struct SphereCone {
    axis: Vec3,
    distance: f32,
    one_minus_cos: f32,
}

impl SphereLight {
    pub(super) fn new(
        radius_m: f64,
        to_render: &DAffine3,
        material: MaterialId,
        material_table: &MaterialTable,
    ) -> Self {
        Self::with_surface(radius_m, to_render, material, SphereSurface::new(material, material_table))
    }

    /// A sphere of a material with these properties.
    pub(super) fn with_surface(
        radius_m: f64,
        to_render: &DAffine3,
        material: MaterialId,
        surface: SphereSurface,
    ) -> Self {
        let linear = to_render.matrix3 * radius_m;
        let centre = to_render.translation.as_vec3();
        let longest = linear.x_axis.length().max(linear.y_axis.length()).max(linear.z_axis.length());
        Self {
            centre,
            linear: linear.as_mat3(),
            normals: linear.inverse().transpose().as_mat3(),
            determinant: linear.determinant().abs() as f32,
            radius: round_radius(&linear).filter(|_| !surface.lets_pass).map(|r| r as f32),
            area_m2: mean_area(&linear),
            error_m: ROUNDING * (centre.abs().max_element() + longest as f32),
            material,
            textured: surface.textured,
        }
    }

    /// Bounds for light selection, at a mean radiance: its projected area is about a quarter of its surface from everywhere.
    pub(super) fn bounds(&self, radiance: f64) -> LightBounds {
        let rows = self.linear.transpose();
        let half = Vec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        let points = [self.centre - half, self.centre + half];
        let bounds = LightBounds::from_surface(&points, 0.25 * radiance * self.area_m2, None);
        // Margin for rounding.
        LightBounds { radius: half.max_element().min(bounds.radius) * (1.0 + 1e-5), ..bounds }
    }

    /// The cone that it covers, with its radius, seen from outside; `None` from inside or if it is not round.
    fn cone(&self, from: Vec3) -> Option<(SphereCone, f32)> {
        let radius = self.radius?;
        let to_light = self.centre - from;
        let distance = to_light.length();
        let sin = radius / distance;
        // A point on the sphere itself is inside to the precision of f32.
        if sin.is_nan() || sin >= 1.0 - 1e-6 {
            return None;
        }
        let sin2 = sin * sin;
        let one_minus_cos = sin2 / (1.0 + (1.0 - sin2).sqrt());
        (one_minus_cos > 0.0).then_some((SphereCone { axis: to_light / distance, distance, one_minus_cos }, radius))
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<SurfaceSample> {
        match self.cone(from) {
            Some((cone, radius)) => Some(self.sample_cone(&cone, radius, from, u)),
            None => self.sample_area(from, u),
        }
    }

    fn sample_cone(&self, cone: &SphereCone, radius: f32, from: Vec3, u: Vec2) -> SurfaceSample {
        let local = uniform_cone(u, cone.one_minus_cos);
        let direction = Basis::about(cone.axis).outward(local);
        // Not by 1 − z²: for a small cone few digits of z are left, and points beyond the limb would be sampled.
        let aside2 = cone.distance * cone.distance * (local.x * local.x + local.y * local.y);
        let near = cone.distance * local.z - (radius * radius - aside2).max(0.0).sqrt();
        let normal = (from + direction * near - self.centre).normalize_or(-cone.axis);
        let (uv, uv_per_m) = self.texture(self.linear.transpose() * normal);
        let pdf = 1.0 / (TAU * cone.one_minus_cos);
        let to_light = self.centre + normal * radius - from;
        SurfaceSample { to_light, distance: to_light.length(), normal, pdf, uv, uv_per_m }
    }

    fn sample_area(&self, from: Vec3, u: Vec2) -> Option<SurfaceSample> {
        let own = uniform_sphere(u);
        let stretched = self.normals * own;
        let per_area = 1.0 / (4.0 * PI * self.determinant * stretched.length());
        let normal = stretched.normalize_or(own);
        let to_light = self.centre + self.linear * own - from;
        let distance = to_light.length();
        let pdf = solid_angle_pdf(per_area, to_light, distance, normal);
        let (uv, uv_per_m) = self.texture(own);
        (pdf > 0.0).then_some(SurfaceSample { to_light, distance, normal, pdf, uv, uv_per_m })
    }

    /// Texture coordinates where the sphere's own normal is along `own`, and their change per metre.
    fn texture(&self, own: Vec3) -> (Vec2, f32) {
        if !self.textured {
            return (Vec2::ZERO, 0.0);
        }
        let unit = own.as_dvec3().normalize_or(DVec3::Z);
        let mean_radius_m = (self.area_m2 / (4.0 * core::f64::consts::PI)).sqrt();
        (sphere::uv(unit).as_vec2(), sphere::uv_per_m(mean_radius_m) as f32)
    }

    pub(super) fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        if let Some((cone, _)) = self.cone(hit.receiver.position) {
            return 1.0 / (TAU * cone.one_minus_cos);
        }
        let normal = hit.point.geometric_normal;
        let stretch = self.determinant / (self.linear.transpose() * normal).length();
        solid_angle_pdf(1.0 / (4.0 * PI * stretch), hit.direction * hit.distance_m, hit.distance_m, normal)
    }

    /// Maximum distance of a stored point from where the accelerator sees it, m.
    pub(super) fn error_m(&self) -> f32 {
        self.error_m
    }

    pub(super) fn glowing<'a>(&self, material_table: &'a MaterialTable) -> SurfaceEmission<'a> {
        SurfaceEmission { material: self.material, error_m: self.error_m, early_m: 0.0, material_table }
    }
}

/// The radius if all directions are stretched equally, to f32's precision.
fn round_radius(linear: &DMat3) -> Option<f64> {
    let square = linear.x_axis.length_squared();
    let deviation = (linear.transpose() * *linear - DMat3::from_diagonal(DVec3::splat(square))).to_cols_array();
    deviation.iter().all(|x| x.abs() <= 1e-6 * square).then_some(square.sqrt())
}

/// 4π times the root mean square of the stretch of area: exact for a sphere, slightly too large for an ellipsoid.
fn mean_area(linear: &DMat3) -> f64 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *linear;
    let squares = x.cross(y).length_squared() + y.cross(z).length_squared() + z.cross(x).length_squared();
    4.0 * core::f64::consts::PI * (squares / 3.0).sqrt()
}
