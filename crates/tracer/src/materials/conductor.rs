//! Metals: a GGX surface with the exact Fresnel reflectance of a complex index at each wavelength.
//!
//! f = F(n, k) · D · G₂ / (4 cos θₒ cos θᵢ); see `microfacet` for the terms. A roughness α below [`super::MIRROR_ALPHA`] is
//! an exact mirror. Light scattered among facets more than
//! once is left out.

use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::metal::ComplexIndex;
use glam::{Vec2, Vec3};

use super::microfacet::{Ggx, half_vector, mirrored};
use super::{BsdfSample, BsdfValue, Event, Factor, MaterialError, fresnel};
use crate::textures::{ImageTexture, Lookup};

/// A metal surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Conductor {
    index: ComplexIndex,
    alpha: Factor,
}

impl Conductor {
    /// A metal of complex index `index` and roughness `alpha` (GGX α, 0 to 1).
    ///
    /// # Errors
    /// Where the roughness is outside 0–1 or the index is not a substance's (n² + k² must be positive and finite).
    pub fn new(index: ComplexIndex, alpha: impl Into<Factor>) -> Result<Self, MaterialError> {
        let alpha = alpha.into().checked_alpha()?;
        match (300_u16..=1100).find(|nm| !is_a_substance(&index, f32::from(*nm))) {
            Some(nm) => Err(MaterialError::Index { nm }),
            None => Ok(Self { index, alpha }),
        }
    }

    /// The roughness α.
    #[must_use]
    pub fn alpha(&self) -> Factor {
        self.alpha
    }

    pub(super) fn resolve<const N: usize>(
        &self,
        textures: &[ImageTexture],
        lookup: &Lookup,
        wavelengths: &Wavelengths<N>,
    ) -> ConductorBsdf<N> {
        ConductorBsdf {
            n: self.index.n.sample(wavelengths),
            k: self.index.k.sample(wavelengths),
            facets: Ggx::of(self.alpha.at(textures, lookup)),
        }
    }
}

fn is_a_substance(index: &ComplexIndex, nm: f32) -> bool {
    let (n, k) = (index.n.at(nm), index.k.at(nm));
    n >= 0.0 && k >= 0.0 && n * n + k * k > 1e-9 && (n * n + k * k) < 1e9
}

/// A metal at a path's wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorBsdf<const N: usize> {
    n: Spectral<N>,
    k: Spectral<N>,
    /// `None` for a mirror.
    facets: Option<Ggx>,
}

impl<const N: usize> ConductorBsdf<N> {
    fn fresnel(&self, cos_i: f32) -> Spectral<N> {
        Spectral::from_fn(|i| fresnel::conductor(cos_i, self.n[i], self.k[i]))
    }

    pub(super) fn is_mirror(&self) -> bool {
        self.facets.is_none()
    }

    pub(super) fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let Some(facets) = self.facets else { return BsdfValue::ZERO };
        let m = half_vector(wo, wi);
        BsdfValue { value_cos: self.fresnel(wo.dot(m)) * facets.reflect(wo, wi, m), pdf: facets.reflect_pdf(wo, m) }
    }

    pub(super) fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample<N>> {
        let Some(facets) = self.facets else { return Some(BsdfSample::mirror(wo, self.fresnel(wo.z))) };
        let m = facets.sample(wo, u);
        let wi = mirrored(wo, m);
        (wi.z > 0.0).then(|| BsdfSample {
            wi,
            weight: self.fresnel(wo.dot(m)) * facets.weight(wo, wi),
            pdf: facets.reflect_pdf(wo, m),
            event: Event::Scatter,
        })
    }
}
