//! Common parts of lights that are surfaces.

use glam::{Vec2, Vec3};

use super::light_sample::LightSample;
use crate::materials::{EmissionQuery, MaterialTable};
use crate::textures::Lookup;

/// A point of a light's surface, sampled for a point of the scene.
pub(super) struct SurfaceSample {
    /// Vector from the point of the scene, and its length, m.
    pub(super) to_light: Vec3,
    pub(super) distance: f32,
    pub(super) normal: Vec3,
    /// By solid angle, without the choice of the light.
    pub(super) pdf: f32,
    pub(super) uv: Vec2,
    pub(super) uv_per_m: f32,
}

impl SurfaceSample {
    /// Unit direction to the point; `None` if it is the receiver itself.
    #[inline(always)]
    pub(super) fn direction(&self) -> Option<Vec3> {
        (self.distance > 0.0).then(|| self.to_light * (1.0 / self.distance))
    }

    /// The point, moved off its surface by the error bound, and towards the receiver by the distance at which the accelerator may hit the
    /// surface early.
    #[inline(always)]
    pub(super) fn target(&self, from: Vec3, direction: Vec3, error_m: f32, early_m: f32) -> Vec3 {
        let side = -1.0_f32.copysign(self.normal.dot(direction));
        from + (self.to_light - direction * early_m.min(0.5 * self.distance))
            + self.normal * (side * (error_m + ROUNDING * self.distance))
    }
}

/// Common data of surface lights.
pub(super) struct SurfaceEmission<'a> {
    pub(super) material: crate::MaterialId,
    pub(super) error_m: f32,
    /// Distance before the point, along the ray to it, at which the accelerator may already hit the surface.
    pub(super) early_m: f32,
    pub(super) material_table: &'a MaterialTable,
}

impl SurfaceEmission<'_> {
    /// The light sample of a surface sample seen from `from`, with its strength at the queried time; `None` if the visible side does not
    /// emit.
    #[inline(always)]
    pub(super) fn towards<const N: usize>(
        &self,
        surface: &SurfaceSample,
        from: Vec3,
        spread_rad: f32,
        query: EmissionQuery<'_, N>,
    ) -> Option<LightSample<N>> {
        let distance = surface.distance;
        let direction = surface.direction()?;
        let emission =
            self.material_table.emission(self.material).filter(|e| e.emits_towards(surface.normal, -direction))?;
        let lookup = Lookup { width: spread_rad * distance * surface.uv_per_m, ..Lookup::point(surface.uv) };
        Some(LightSample {
            direction,
            target: Some(surface.target(from, direction, self.error_m, self.early_m)),
            radiance: self.material_table.radiance(self.material, emission, &lookup, query),
            pdf: surface.pdf,
            delta: false,
            is_environment: false,
        })
    }
}

/// Relative error allowed for a point on a light and a ray to it: sixteen roundings of f32.
pub(super) const ROUNDING: f32 = 16.0 * 0.5 * f32::EPSILON;

/// Density by solid angle of a point sampled with density `per_area` (1/m²) on a surface of unit `normal`, seen from a point at the far end
/// of `way` of length `distance`; 0 if it is seen edge-on.
pub(super) fn solid_angle_pdf(per_area: f32, to_light: Vec3, distance: f32, normal: Vec3) -> f32 {
    let height = normal.dot(to_light).abs();
    if height > 0.0 { per_area * (distance * distance) * (distance / height) } else { 0.0 }
}
