//! Emitting triangles and parallelograms, sampled uniformly by solid angle from near by, and by area from afar.
//!
//! Two triangles that form a parallelogram are one light. Sample points on it are then as well distributed as the numbers in their square, and there
//! are half as many lights to choose from.

use etendue_core::warp::uniform_triangle;
use glam::{DAffine3, DVec3, Mat3, Vec2, Vec3};

use super::near::{FlatLight, NearRegion, NearView};
use super::{LightHit, ROUNDING, SurfaceEmission, SurfaceSample, solid_angle_pdf, tree::LightBounds};
use crate::{MaterialId, geometry::Mesh, materials::MaterialTable};

/// An emitting triangle in the render frame, or a parallelogram.
#[derive(Clone, Debug)]
pub(super) struct TriangleLight {
    flat: FlatLight,
    /// On the same side as the surface's geometric normal: that of the winding in the mesh's own frame.
    normal: Vec3,
    per_area: f32,
    /// Region in which it is sampled by solid angle.
    nearness: NearRegion,
    uvs: [Vec2; 3],
    uv_per_m: f32,
    error_m: f32,
    material: MaterialId,
}

impl TriangleLight {
    /// `None` if rounding leaves no area: such a triangle sends no light that could be sampled.
    pub(super) fn new(mesh: &Mesh, primitive: usize, to_render: &DAffine3, material: MaterialId) -> Option<Self> {
        FlatShape::one(mesh, primitive).light(to_render, material)
    }

    fn from_corners(corners: &TriangleCorners, to_render: &DAffine3, material: MaterialId) -> Option<Self> {
        let TriangleCorners { own, uvs } = *corners;
        let [a, b, c] = own.map(|p| to_render.transform_point3(p.as_dvec3()));
        let doubled = (b - a).cross(c - a) * 1.0_f64.copysign(to_render.matrix3.determinant());
        let per_area = (2.0 / doubled.length()) as f32;
        let uv_area = (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]).abs();
        let linear = to_render.matrix3.as_mat3();
        let flat = FlatLight { corner: a.as_vec3(), edges: [(b - a).as_vec3(), (c - a).as_vec3()], doubled: false };
        let light = Self {
            flat,
            normal: doubled.normalize_or_zero().as_vec3(),
            per_area,
            nearness: NearRegion::new(&flat),
            uvs,
            uv_per_m: (0.5 * uv_area * per_area).sqrt(),
            error_m: error_bound(own, linear, to_render.translation.as_vec3()),
            material,
        };
        (per_area.is_finite() && per_area > 0.0).then_some(light)
    }

    /// The parallelogram of two triangles of a mesh; `None` if they form none, to the rounding of coordinates.
    pub(super) fn from_parallelogram(
        mesh: &Mesh,
        primitives: [usize; 2],
        to_render: &DAffine3,
        material: MaterialId,
    ) -> Option<Self> {
        FlatShape::two(mesh, primitives)?.light(to_render, material)
    }

    /// Number of its triangles.
    pub(super) fn triangles(&self) -> usize {
        1 + usize::from(self.flat.doubled)
    }

    pub(super) fn area_m2(&self) -> f64 {
        1.0 / f64::from(self.per_area)
    }

    /// On the same side as the surface's geometric normal.
    pub(super) fn normal(&self) -> Vec3 {
        self.normal
    }

    /// The middle of a parallelogram, render frame, m.
    pub(super) fn middle(&self) -> Vec3 {
        self.flat.at(Vec2::splat(0.5))
    }

    /// Maximum distance of a stored point from where the accelerator sees it, and distance before it at which a ray may be hit, m.
    pub(super) fn rounding_m(&self) -> (f32, f32) {
        (self.error_m, self.flat.early_m())
    }

    /// Bounds for light selection, at a mean radiance; `both` sides emit or only the front.
    pub(super) fn bounds(&self, radiance: f64, both: bool) -> LightBounds {
        let corners = self.flat.corners();
        // A side's intensity falls by the cosine, whose mean over all directions is one half.
        let fraction = if both { 0.5 } else { 1.0 };
        LightBounds::from_surface(&corners, fraction * radiance * self.area_m2(), (!both).then_some(self.normal))
    }

    #[inline(always)]
    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<SurfaceSample> {
        let near = self.near(from);
        let b = match &near {
            Some(near) => near.place(u)?,
            None if self.flat.doubled => u,
            None => uniform_triangle(u),
        };
        let to_light = self.flat.at(b) - from;
        let distance = to_light.length();
        let pdf = self.density(near.as_ref(), to_light, distance);
        let uv = self.uvs[0] * (1.0 - b.x - b.y) + self.uvs[1] * b.x + self.uvs[2] * b.y;
        (pdf > 0.0).then_some(SurfaceSample {
            to_light,
            distance,
            normal: self.normal,
            pdf,
            uv,
            uv_per_m: self.uv_per_m,
        })
    }

    pub(super) fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        let near = self.near(hit.receiver.position);
        self.density(near.as_ref(), hit.direction * hit.distance_m, hit.distance_m)
    }

    /// Density by solid angle of the point at the end of `way`.
    #[inline(always)]
    fn density(&self, near: Option<&NearView>, to_light: Vec3, distance: f32) -> f32 {
        match near {
            Some(near) => near.per_sr,
            None => solid_angle_pdf(self.per_area, to_light, distance, self.normal),
        }
    }

    /// The light as seen from near by; `None` from afar, or if its solid angle is too small.
    #[inline(always)]
    fn near(&self, from: Vec3) -> Option<NearView> {
        if self.nearness.holds(from) { NearView::new(&self.flat, from) } else { None }
    }

    pub(super) fn glowing<'a>(&self, material_table: &'a MaterialTable) -> SurfaceEmission<'a> {
        SurfaceEmission { material: self.material, error_m: self.error_m, early_m: self.flat.early_m(), material_table }
    }
}

/// A triangle in its own frame, or two that form a parallelogram.
#[derive(Clone, Debug)]
pub(super) struct FlatShape {
    near: TriangleCorners,
    far: Option<TriangleCorners>,
}

impl FlatShape {
    pub(super) fn one(mesh: &Mesh, primitive: usize) -> Self {
        Self { near: TriangleCorners::new(mesh, primitive), far: None }
    }

    /// `None` if the two form no parallelogram, to the rounding of coordinates.
    pub(super) fn two(mesh: &Mesh, primitives: [usize; 2]) -> Option<Self> {
        let corners = primitives.map(|primitive| TriangleCorners::new(mesh, primitive));
        let turn =
            (0..9).find(|turn| corners[0].rotated(turn % 3).forms_parallelogram_with(&corners[1].rotated(turn / 3)))?;
        Some(Self { near: corners[0].rotated(turn % 3), far: Some(corners[1].rotated(turn / 3)) })
    }

    /// Number of its triangles.
    pub(super) fn triangles(&self) -> usize {
        1 + usize::from(self.far.is_some())
    }

    /// Minimum and maximum coordinates in its own frame.
    pub(super) fn own_box(&self) -> (DVec3, DVec3) {
        let corners = self.far.iter().fold(self.near.own.to_vec(), |corners, far| [corners, far.own.to_vec()].concat());
        let corners = corners.into_iter().map(Vec3::as_dvec3);
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// The light at its placement; `None` if rounding leaves no area.
    pub(super) fn light(&self, to_render: &DAffine3, material: MaterialId) -> Option<TriangleLight> {
        let single = TriangleLight::from_corners(&self.near, to_render, material)?;
        let Some(far) = &self.far else { return Some(single) };
        let error_m = single.error_m.max(TriangleLight::from_corners(far, to_render, material)?.error_m);
        let flat = FlatLight { doubled: true, ..single.flat };
        Some(TriangleLight {
            flat,
            nearness: NearRegion::new(&flat),
            per_area: 0.5 * single.per_area,
            error_m,
            ..single
        })
    }
}

/// The corners of a triangle in its own frame, with their texture coordinates.
#[derive(Clone, Copy, Debug)]
struct TriangleCorners {
    own: [Vec3; 3],
    uvs: [Vec2; 3],
}

impl TriangleCorners {
    fn new(mesh: &Mesh, primitive: usize) -> Self {
        let uvs = mesh.triangles()[primitive].map(|v| mesh.uvs().get(v as usize).copied().unwrap_or_default());
        Self { own: mesh.corners(primitive as u32), uvs }
    }

    /// The same triangle, starting with another corner.
    fn rotated(&self, by: usize) -> Self {
        let Self { mut own, mut uvs } = *self;
        own.rotate_left(by);
        uvs.rotate_left(by);
        Self { own, uvs }
    }

    /// True if `far` has the side that faces the first corner, seen from the same side, and both form a parallelogram.
    fn forms_parallelogram_with(&self, far: &Self) -> bool {
        let coincide = |one: usize, other: usize| self.own[one] == far.own[other] && self.uvs[one] == far.uvs[other];
        let closes = |one: [f32; 3], far: f32| {
            let largest = one.into_iter().fold(far.abs(), |maximum, x| maximum.max(x.abs()));
            ((one[1] - one[0]) - (far - one[2])).abs() <= CLOSURE_TOLERANCE * largest
        };
        let near = |axis: usize| self.own.map(|p| p[axis]);
        let near_uv = |axis: usize| self.uvs.map(|p| p[axis]);
        coincide(1, 2)
            && coincide(2, 1)
            && (0..3).all(|axis| closes(near(axis), far.own[0][axis]))
            && (0..2).all(|axis| closes(near_uv(axis), far.uvs[0][axis]))
    }
}

/// Maximum distance of a parallelogram's fourth corner from where the others put it, in units of the largest coordinate: four roundings of
/// f32 and a margin for those of the test.
const CLOSURE_TOLERANCE: f32 = 8.0 * 0.5 * f32::EPSILON;

/// Maximum distance of a stored point from where the accelerator sees the triangle: roundings of the coordinates in the mesh's own frame
/// and in the render frame.
fn error_bound(own: [Vec3; 3], linear: Mat3, translation: Vec3) -> f32 {
    let largest = own.into_iter().fold(Vec3::ZERO, |m, p| m.max(p.abs()));
    let carried = linear.x_axis.abs() * largest.x + linear.y_axis.abs() * largest.y + linear.z_axis.abs() * largest.z;
    ROUNDING * (carried.max_element() + translation.abs().max_element())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles over four corners, named in these orders.
    fn two(corners: [Vec3; 4], triangles: [[u32; 3]; 2]) -> Option<TriangleLight> {
        let mesh = Mesh::new(corners.to_vec(), vec![], vec![], triangles.to_vec(), vec![]).expect("legal").0;
        TriangleLight::from_parallelogram(&mesh, [0, 1], &DAffine3::IDENTITY, MaterialId(0))
    }

    fn slanted() -> [Vec3; 4] {
        let (corner, along, across) =
            (Vec3::new(0.3, 0.2, 3.1), Vec3::new(0.13, 0.0, 0.05), Vec3::new(0.02, 0.105, 0.0));
        [corner, corner + along, corner + along + across, corner + across]
    }

    #[test]
    fn two_triangles_make_a_parallelogram_however_they_are_begun() {
        let [a, b, _, d] = slanted();
        let area = f64::from((b - a).cross(d - a).length());
        for turn in 0..9 {
            let (mut near, mut far) = ([0, 1, 2], [0, 2, 3]);
            near.rotate_left(turn % 3);
            far.rotate_left(turn / 3);
            let light = two(slanted(), [near, far]).expect("a parallelogram");
            // Roundings of coordinates of 3 to edges of 0.1.
            assert!((light.area_m2() / area - 1.0).abs() < 1e-5 && light.triangles() == 2);
            let mut mean = Vec3::ZERO;
            for i in 0..64 {
                let u = Vec2::new((i % 8) as f32 + 0.5, (i / 8) as f32 + 0.5) / 8.0;
                mean += light.sample(Vec3::ZERO, u).expect("seen").to_light / 64.0;
            }
            assert!((mean - (b + d) * 0.5).length() < 2e-6, "{mean}");
        }
    }

    #[test]
    fn other_pairs_are_two_triangles() {
        let both = [[0, 1, 2], [0, 2, 3]];
        assert!(two(slanted(), [[0, 1, 2], [0, 3, 2]]).is_none(), "wound against each other");
        let mut bent = slanted();
        bent[3].z += 1e-4;
        assert!(two(bent, both).is_none());
        let mut kite = slanted();
        kite[3] = kite[0] + (kite[2] - kite[0]) * 0.5 + (kite[3] - kite[1]);
        assert!(two(kite, both).is_none());
        let own = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y * 0.5];
        let mesh = Mesh::new(slanted().to_vec(), vec![], own, both.to_vec(), vec![]).expect("legal").0;
        let light = TriangleLight::from_parallelogram(&mesh, [0, 1], &DAffine3::IDENTITY, MaterialId(0));
        assert!(light.is_none(), "a texture that is bent at the diagonal");
    }
}
