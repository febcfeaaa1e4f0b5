//! Matt surfaces: Lambert's law.
//!
//! f = ρ/π, 1/sr, at every pair of directions; ρ is the reflectance in [0, 1]. Sampled by the cosine.

use core::f32::consts::FRAC_1_PI;
use etendue_core::Spectral;
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use glam::{Vec2, Vec3};

use super::{BsdfSample, BsdfValue, Event};

/// Lambert's law with the reflectances of one point at a path's wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseBsdf<const N: usize> {
    /// Reflectance ρ.
    pub reflectance: Spectral<N>,
}

impl<const N: usize> DiffuseBsdf<N> {
    pub(super) fn evaluate(&self, wi: Vec3) -> BsdfValue<N> {
        BsdfValue { value_cos: self.reflectance * (wi.z * FRAC_1_PI), pdf: cosine_hemisphere_pdf(wi.z) }
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<BsdfSample<N>> {
        let wi = cosine_hemisphere(u);
        let pdf = cosine_hemisphere_pdf(wi.z);
        (pdf > 0.0).then_some(BsdfSample { wi, weight: self.reflectance, pdf, event: Event::Scatter })
    }
}
