//! Glowing triangles, drawn uniformly by area.

use etendue_core::warp::uniform_triangle;
use glam::{DAffine3, Mat3, Vec2, Vec3};

use super::tree::LightBounds;
use super::{Glowing, Met, ROUNDING, SurfaceSample, solid_angle_pdf};
use crate::MaterialId;
use crate::geometry::Mesh;
use crate::materials::Palette;

/// A glowing triangle in the render frame.
#[derive(Clone, Debug)]
pub(super) struct TriangleLight {
    corner: Vec3,
    edges: [Vec3; 2],
    /// On the same side as the surface's geometric normal: that of the winding in the mesh's own frame.
    normal: Vec3,
    per_area: f32,
    uvs: [Vec2; 3],
    uv_per_m: f32,
    error_m: f32,
    material: MaterialId,
}

impl TriangleLight {
    /// `None` where rounding leaves no area: such a triangle sends no light that could be drawn.
    pub(super) fn new(mesh: &Mesh, primitive: usize, to_render: &DAffine3, material: MaterialId) -> Option<Self> {
        let own = mesh.corners(primitive as u32);
        let [a, b, c] = own.map(|p| to_render.transform_point3(p.as_dvec3()));
        let doubled = (b - a).cross(c - a) * 1.0_f64.copysign(to_render.matrix3.determinant());
        let per_area = (2.0 / doubled.length()) as f32;
        let uvs = mesh.triangles()[primitive].map(|v| mesh.uvs().get(v as usize).copied().unwrap_or_default());
        let uv_area = (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]).abs();
        let linear = to_render.matrix3.as_mat3();
        let light = Self {
            corner: a.as_vec3(),
            edges: [(b - a).as_vec3(), (c - a).as_vec3()],
            normal: doubled.normalize_or_zero().as_vec3(),
            per_area,
            uvs,
            uv_per_m: (0.5 * uv_area * per_area).sqrt(),
            error_m: error_bound(own, linear, to_render.translation.as_vec3()),
            material,
        };
        (per_area.is_finite() && per_area > 0.0).then_some(light)
    }

    pub(super) fn area_m2(&self) -> f64 {
        1.0 / f64::from(self.per_area)
    }

    /// For the choice among lights, at a mean radiance; `both` sides glow or only the front.
    pub(super) fn bounds(&self, radiance: f64, both: bool) -> LightBounds {
        let corners = [self.corner, self.corner + self.edges[0], self.corner + self.edges[1]];
        // A side's intensity falls by the cosine, whose mean over all directions is one half.
        let share = if both { 0.5 } else { 1.0 };
        LightBounds::of_surface(&corners, share * radiance * self.area_m2(), (!both).then_some(self.normal))
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<SurfaceSample> {
        let b = uniform_triangle(u);
        let position = self.corner + self.edges[0] * b.x + self.edges[1] * b.y;
        let pdf = solid_angle_pdf(self.per_area, position - from, self.normal);
        let uv = self.uvs[0] * (1.0 - b.x - b.y) + self.uvs[1] * b.x + self.uvs[2] * b.y;
        (pdf > 0.0).then_some(SurfaceSample { position, normal: self.normal, pdf, uv, uv_per_m: self.uv_per_m })
    }

    pub(super) fn pdf(&self, met: &Met<'_>) -> f32 {
        solid_angle_pdf(self.per_area, met.direction * met.distance_m, self.normal)
    }

    pub(super) fn glowing<'a>(&self, palette: &'a Palette) -> Glowing<'a> {
        Glowing { material: self.material, error_m: self.error_m, palette }
    }
}

/// How far a stored point may be from where the accelerator sees the triangle: roundings of the coordinates in
/// the mesh's own frame and in the render frame.
fn error_bound(own: [Vec3; 3], linear: Mat3, translation: Vec3) -> f32 {
    let largest = own.into_iter().fold(Vec3::ZERO, |m, p| m.max(p.abs()));
    let carried = linear.x_axis.abs() * largest.x + linear.y_axis.abs() * largest.y + linear.z_axis.abs() * largest.z;
    ROUNDING * (carried.max_element() + translation.abs().max_element())
}
