//! The surface at a vertex: texture look-ups, shading frame, BSDF, and the densities of directions that are sampled there.
//!
//! **Path-space regularisation**: microfacet lobes at least as wide as the widest lobe that has scattered the path.
//!
//! A path that a wide lobe has scattered hits the reflection of a light in a narrower lobe by chance only: in a few samples, too bright by the ratio
//! of the two lobes. If a caller requests it ([`super::PathSettings::regularize`]), each microfacet lobe (metals, coats, paint, glass) is widened
//! until its density is at most [`MAX_DENSITY_RATIO`] of that of the widest scattering before it, or [`MIN_DENSITY_PER_SR`] (Kaplanyan and
//! Dachsbacher, "Path space regularization for holistic and robust light transport", 2013; there of mirrors).
//!
//! Surfaces seen straight or in mirrors are unchanged. Reflections of lights in reflections of other surfaces are blurred. Their light is kept,
//! except what models lose at greater roughness. The mean changes: the image is biased. If caustics are left out, those behind diffuse surfaces still
//! are: nothing is widened there. A mirror that a glossy surface shows is widened, and counts. The density is that of reflection: light that glass
//! refracts straight on stays up to 36 times as dense (n = 1.5).

use core::f32::consts::PI;

use etendue_core::{LightSampling, maths::f32::cbrt, random::Draw};
use glam::{Vec2, Vec3};

use super::path::{Path, Vertex};
use super::path_state::{PathCone, PathMedium};
use super::path_tracer::Effects;
use crate::guiding::{DirectionDistribution, GUIDED_BOUNCES};
use crate::materials::{Bsdf, BsdfSample, BsdfValue, DiffuseBsdf, Event, GlossLobe, ShadingFrame};
use crate::{MaterialId, geometry::SurfacePoint, lights::ReceiverGloss, textures::Lookup};

/// Maximum density of a lobe over that of the widest scattering before it. Tried: 4, 1, 1/2, 0.3 and 0.2, on car paint that sees a wet road
/// at 64 samples. The last two leave no speckle.
const MAX_DENSITY_RATIO: f32 = 0.25;

/// Density that any lobe may have, 1/sr: that of a GGX lobe of α = 0.28 along the normal.
const MIN_DENSITY_PER_SR: f32 = 1.0;

// Behind diffuse surfaces all lobes are equally wide, so that paths that share a tail agree on it.
const _: () = assert!(MAX_DENSITY_RATIO / PI < MIN_DENSITY_PER_SR);

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// Place of texture look-ups at a point that a ray of unit `direction` has hit; `cone` is its cone there.
    #[inline(always)]
    pub(super) fn lookup(&self, point: &SurfacePoint, cone: PathCone, direction: Vec3) -> Lookup {
        let at = Lookup { local: point.local, local_normal: point.local_normal, ..Lookup::point(point.uv) };
        if !(E::SURFACES && self.tracer.material_table.needs_footprint(point.material)) {
            return at;
        }
        let at = Lookup { origin: self.tracer.view.local_origin(point.instance), ..at };
        let footprint = self.tracer.view.footprint(point);
        let width_m = cone.width_m;
        let round = Lookup { width: width_m * footprint.uv_per_m, width_local: width_m * footprint.local_per_m, ..at };
        match cone.long_side(point.geometric_normal, direction) {
            None => round,
            Some(vector) => {
                let (long, long_local) = self.tracer.view.change_along(point, vector);
                Lookup { long, long_local, ..round }
            }
        }
    }

    /// The material, shading frame and BSDF at a point that the ray has hit.
    #[inline(always)]
    pub(super) fn vertex(&self, point: SurfacePoint, lookup: &Lookup) -> Vertex<'a, N> {
        let material_table = self.tracer.material_table;
        let material = if E::SURFACES && material_table.is_mix(point.material) {
            material_table.resolve(point.material, lookup, self.camera_ray.stream.one(Draw::Mix, self.vertex_index))
        } else {
            point.material
        };
        let frame = self.frame(material, &point, lookup, self.ray.direction);
        let bsdf = if E::SURFACES {
            material_table.widened_bsdf(material, lookup, frame.front, self.min_alpha(&frame), self.wavelengths)
        } else {
            material_table.diffuse_bsdf(material, self.wavelengths)
        };
        Vertex { guide: self.guide(&bsdf, &point, &frame), bsdf, point, frame, material }
    }

    /// The shading frame of a material at a point that a ray of unit `direction` has hit.
    #[inline(always)]
    pub(super) fn frame(
        &self,
        material: MaterialId,
        point: &SurfacePoint,
        lookup: &Lookup,
        direction: Vec3,
    ) -> ShadingFrame {
        let material_table = self.tracer.material_table;
        let normal = if E::SURFACES && material_table.needs_tangents(material) {
            material_table.shading_normal(material, lookup, point, self.tracer.view.tangents(point))
        } else {
            point.shading_normal
        };
        ShadingFrame::new(point, normal, -direction)
    }

    /// Minimum roughness α of microfacets at a surface that the path has hit: 0 if they are not widened.
    #[inline(always)]
    fn min_alpha(&self, frame: &ShadingFrame) -> f32 {
        let settings = &self.tracer.settings;
        let is_left_out = self.history.has_diffuse() && !settings.caustics;
        if !settings.regularize || self.bounces == 0 || is_left_out {
            return 0.0;
        }
        alpha_of_density((MAX_DENSITY_RATIO * self.history.min_density()).max(MIN_DENSITY_PER_SR), frame.wo.z)
    }

    /// The distribution of directions that a diffuse surface samples, if other paths have trained one.
    #[inline(always)]
    fn guide(
        &self,
        bsdf: &Bsdf<'a, N>,
        point: &SurfacePoint,
        frame: &ShadingFrame,
    ) -> Option<&'a DirectionDistribution> {
        let guide = self.tracer.guide?;
        if self.bounces >= GUIDED_BOUNCES || !matches!(bsdf, Bsdf::Diffuse(_)) {
            return None;
        }
        guide.at(point.position, frame.normal())
    }

    /// The lobes of a surface for the choice among lights: none if light that lobes reflect is left out as a caustic, or lobes do not
    /// count.
    #[inline(always)]
    pub(super) fn gloss(&self, vertex: &Vertex<'a, N>) -> Option<ReceiverGloss> {
        let counts_lobes = self.tracer.settings.light_sampling == LightSampling::Gloss;
        if !counts_lobes || !self.includes(self.history.has_diffuse()) {
            return None;
        }
        let counts = |lobe: &GlossLobe| self.includes(self.history.would_be_caustic(lobe.density_at_axis()));
        ReceiverGloss::new(&vertex.bsdf.gloss(vertex.frame.wo).retain_lobes(counts), &vertex.frame)
    }

    /// Value and density of light that arrives at a surface from `wi`.
    #[inline(always)]
    pub(super) fn evaluate(&self, vertex: &Vertex<'_, N>, wi: Vec3) -> BsdfValue<N> {
        match &vertex.bsdf {
            Bsdf::Diffuse(bsdf) if !E::SURFACES => bsdf.evaluate_above(wi),
            bsdf => bsdf.evaluate(vertex.frame.wo, wi),
        }
    }

    /// The medium on the side of `wi`, which light crosses before it arrives at a surface.
    pub(super) fn medium_towards(&self, vertex: &Vertex<'a, N>, wi: Vec3) -> PathMedium<'a> {
        if E::SURFACES && wi.z < 0.0 {
            let table = self.tracer.material_table;
            PathMedium::beyond(
                vertex.frame.front,
                table.solid(vertex.material).is_some(),
                table.absorption(vertex.material),
            )
        } else {
            self.medium
        }
    }
}

impl<const N: usize> Vertex<'_, N> {
    /// Density with which `wi` (shading frame) is sampled, 1/sr; `pdf` is that of the BSDF.
    #[inline(always)]
    pub(super) fn density(&self, wi: Vec3, pdf: f32) -> f32 {
        pdf * self.relative_density(wi)
    }

    /// Ratio of the density with which `wi` (shading frame) is sampled to that of the BSDF. Roulette uses the throughput times this, as if
    /// nothing guided the path: a direction that is sampled often carries less, and is worth no less.
    #[inline(always)]
    pub(super) fn relative_density(&self, wi: Vec3) -> f32 {
        self.guide.map_or(1.0, |guide| guide.relative_density(wi))
    }

    /// A direction sampled by the guide; its density is stated as that of the BSDF.
    #[inline(always)]
    pub(super) fn guided_sample(&self, bsdf: &DiffuseBsdf<N>, u: Vec2) -> Option<BsdfSample<N>> {
        let (wi, relative) = self.guide?.sample(u);
        let pdf = etendue_core::warp::cosine_hemisphere_pdf(wi.z);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: bsdf.reflectance / relative, pdf, event: Event::Scatter })
    }
}

/// A roughness α at which a GGX lobe's density at its axis, seen at a cosine, is at most `density`, 1/sr. The density is 1/(2π α² (cos +
/// √(cos² + α² sin²))). The root is at least cos and, with the cosine, at least α. These give two bounds; the lower α suffices.
fn alpha_of_density(density: f32, cos: f32) -> f32 {
    let (steep, grazing) = (1.0 / (4.0 * PI * density * cos).sqrt(), cbrt(1.0 / (2.0 * PI * density)));
    steep.min(grazing).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Ggx;

    #[test]
    fn lobes_are_no_denser_than_asked_and_not_much_wider_than_that_takes() {
        for density in [0.4_f32, 1.3, 4.0, 30.0, 1000.0, 1e6] {
            for cos in [1.0_f32, 0.7, 0.2, 0.03, 1e-3] {
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let peak =
                    |alpha| Ggx::from_alpha(alpha).map_or(f32::INFINITY, |facets| facets.reflect_pdf(wo, Vec3::Z));
                let alpha = alpha_of_density(density, cos);
                assert!(alpha == 1.0 || peak(alpha) <= density * 1.001, "{density} {cos}: {}", peak(alpha));
                assert!(peak(0.6 * alpha) > density || alpha < 1e-4, "{density} {cos}: {alpha}");
            }
        }
        assert_eq!(alpha_of_density(f32::INFINITY, 0.5), 0.0);
    }
}
