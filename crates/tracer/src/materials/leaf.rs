//! Leaves, paper, lampshades: thin sheets that scatter light to both sides.
//!
//! f = ρ/π on the viewer's side, τ/π behind it (1/sr), at every pair of directions: Lambert's law twice. ρ is the
//! reflectance, τ the transmittance, ρ + τ ≤ 1 at every wavelength. Both sides are alike. Sampled by the cosine, the side
//! by its share of ρ + τ. (The bi-Lambertian leaf of canopy models: Ross 1981, *The Radiation Regime and Architecture of
//! Plant Stands*, ch. II.) Left out: the waxy shine of leaves, and that their two sides differ.

use core::f32::consts::FRAC_1_PI;
use etendue_core::Spectral;
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use glam::{Vec2, Vec3};

use super::{BsdfSample, BsdfValue, Event, Reflectance};

/// A sheet that scatters to both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// ρ.
    pub reflectance: Reflectance,
    /// τ.
    pub transmittance: Reflectance,
}

/// A leaf at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafBsdf<const N: usize> {
    reflectance: Spectral<N>,
    transmittance: Spectral<N>,
    /// Probability of the viewer's side.
    share: f32,
}

impl<const N: usize> LeafBsdf<N> {
    pub(super) fn new(reflectance: Spectral<N>, transmittance: Spectral<N>) -> Self {
        let (r, t) = (reflectance.mean(), transmittance.mean());
        let share = if r + t > 0.0 { r / (r + t) } else { 1.0 };
        Self { reflectance, transmittance, share }
    }

    pub(super) fn evaluate(&self, wi: Vec3) -> BsdfValue<N> {
        let (scattered, share) = match wi.z > 0.0 {
            true => (self.reflectance, self.share),
            false => (self.transmittance, 1.0 - self.share),
        };
        let cos = wi.z.abs();
        BsdfValue { value_cos: scattered * (cos * FRAC_1_PI), pdf: share * cosine_hemisphere_pdf(cos) }
    }

    pub(super) fn sample(&self, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let above = cosine_hemisphere(u);
        let (wi, weight, share) = match choice < self.share {
            true => (above, self.reflectance, self.share),
            false => (Vec3::new(above.x, above.y, -above.z), self.transmittance, 1.0 - self.share),
        };
        let pdf = share * cosine_hemisphere_pdf(above.z);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: weight / share, pdf, event: Event::Scatter })
    }
}
