//! Leaves, paper, lampshades: thin sheets that scatter light to both sides.
//!
//! f = ρ/π on the viewer's side, τ/π behind it (1/sr), at every pair of directions: Lambert's law twice. ρ is the reflectance, τ the transmittance, ρ + τ
//! ≤ 1 at every wavelength. Both sides are equal. Sampled by the cosine, the side by its fraction of ρ + τ. (The bi-Lambertian leaf of canopy
//! models: Ross 1981, *The Radiation Regime and Architecture of Plant Stands*, ch. II.) Left out: the waxy shine of leaves, and differences between
//! their two sides.

use core::f32::consts::FRAC_1_PI;

use etendue_core::Spectral;
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use glam::{Vec2, Vec3};

use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck, WHITE};
use super::{error::MaterialError, gloss::Gloss};

/// A sheet that scatters to both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// ρ.
    pub reflectance: Reflectance,
    /// τ.
    pub transmittance: Reflectance,
}

impl SurfaceModel for Leaf {
    type Bsdf<'a, const N: usize> = LeafBsdf<N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(&self.reflectance), Parameter::Reflectance(&self.transmittance)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> LeafBsdf<N> {
        LeafBsdf::new(point.reflectance(&self.reflectance), point.reflectance(&self.transmittance))
    }

    /// Checks that no wavelength gains energy: node by node for spectra, by its maximum value for a texture.
    fn check_energy(&self, check: &TextureCheck<'_>) -> Result<(), MaterialError> {
        let [r, t] = [&self.reflectance, &self.transmittance].map(|part| check.brightest(part));
        let maximum = r.nodes().iter().zip(t.nodes()).map(|(r, t)| r + t).fold(0.0, f32::max);
        if maximum > WHITE {
            return Err(MaterialError::LeafSum { material: check.material, value: maximum });
        }
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// A leaf at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafBsdf<const N: usize> {
    reflectance: Spectral<N>,
    transmittance: Spectral<N>,
    /// Probability of the viewer's side.
    reflected_fraction: f32,
}

impl<const N: usize> LeafBsdf<N> {
    fn new(reflectance: Spectral<N>, transmittance: Spectral<N>) -> Self {
        let (r, t) = (reflectance.mean(), transmittance.mean());
        let fraction = if r + t > 0.0 { r / (r + t) } else { 1.0 };
        Self { reflectance, transmittance, reflected_fraction: fraction }
    }
}

impl<const N: usize> BsdfModel<N> for LeafBsdf<N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags { delta: false, transmits: true, has_parts: true }
    }

    fn evaluate(&self, _wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let (scattered, fraction) = match wi.z > 0.0 {
            true => (self.reflectance, self.reflected_fraction),
            false => (self.transmittance, 1.0 - self.reflected_fraction),
        };
        let cos = wi.z.abs();
        BsdfValue { value_cos: scattered * (cos * FRAC_1_PI), pdf: fraction * cosine_hemisphere_pdf(cos) }
    }

    fn gloss(&self, _: Vec3) -> Gloss {
        Gloss::MATT
    }

    fn sample(&self, _wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let above = cosine_hemisphere(u);
        let (wi, weight, fraction) = match choice < self.reflected_fraction {
            true => (above, self.reflectance, self.reflected_fraction),
            false => (Vec3::new(above.x, above.y, -above.z), self.transmittance, 1.0 - self.reflected_fraction),
        };
        let pdf = fraction * cosine_hemisphere_pdf(above.z);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: weight / fraction, pdf, event: Event::Scatter })
    }
}
