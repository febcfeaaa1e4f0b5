//! Diffuse surfaces: Lambert's law.
//!
//! f = ρ/π, 1/sr, at every pair of directions; ρ is the reflectance in [0, 1]. Sampled by the cosine.

use core::f32::consts::FRAC_1_PI;

use etendue_core::Spectral;
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use glam::{Vec2, Vec3};

use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck};
use super::{error::MaterialError, gloss::Gloss};

/// A reflectance alone is Lambert's law.
impl SurfaceModel for Reflectance {
    type Bsdf<'a, const N: usize> = DiffuseBsdf<N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(self)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    #[inline]
    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> DiffuseBsdf<N> {
        DiffuseBsdf { reflectance: point.reflectance(self) }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Lambert's law with the reflectances of one point at a path's wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseBsdf<const N: usize> {
    /// Reflectance ρ.
    pub reflectance: Spectral<N>,
}

impl<const N: usize> DiffuseBsdf<N> {
    /// Value and density of light from `wi`; zero from behind.
    #[inline(always)]
    pub(crate) fn evaluate_above(&self, wi: Vec3) -> BsdfValue<N> {
        if wi.z <= 0.0 {
            return BsdfValue::ZERO;
        }
        BsdfValue { value_cos: self.reflectance * (wi.z * FRAC_1_PI), pdf: cosine_hemisphere_pdf(wi.z) }
    }

    /// Samples a direction for light to come from; `None` if rounding leaves it in the surface.
    #[inline(always)]
    pub(crate) fn sample_above(&self, u: Vec2) -> Option<BsdfSample<N>> {
        let wi = cosine_hemisphere(u);
        let pdf = cosine_hemisphere_pdf(wi.z);
        (pdf > 0.0).then_some(BsdfSample { wi, weight: self.reflectance, pdf, event: Event::Scatter })
    }
}

impl<const N: usize> BsdfModel<N> for DiffuseBsdf<N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags { delta: false, transmits: false, has_parts: false }
    }

    fn evaluate(&self, _wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        self.evaluate_above(wi)
    }

    fn gloss(&self, _: Vec3) -> Gloss {
        Gloss::MATT
    }

    fn sample(&self, _wo: Vec3, _choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        self.sample_above(u)
    }
}
