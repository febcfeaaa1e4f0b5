//! Metals and other rough interfaces after Cook and Torrance: microfacets with the exact Fresnel reflectance at each wavelength.
//!
//! f = F · D · G₂ / (4 cos θₒ cos θᵢ), 1/sr (Cook and Torrance 1982, with the 4 that energy conservation requires), D GGX or Beckmann with
//! height-correlated Smith shadowing, see `microfacet` and `beckmann`; visible facets are sampled. F is that of a complex index n + ik, or of a real
//! one. Light that enters is absorbed (a diffuse base under such a surface is [`super::CoatedDiffuse`]). A roughness α below [`super::MIRROR_ALPHA`] is an
//! exact mirror: the lobe would be narrower than a hundredth of a degree. The roughness may be a texture, and so may the reflectance of a metal at
//! normal incidence. F is then Schlick's approximation (1994), F₀ + (1 − F₀)(1 − cos θ)⁵, as for all metals in glTF.
//!
//! Multiple scattering among facets is left out (a white surface of α = 1 loses up to six tenths), unless it is requested: see `interreflection`.

use core::f32::consts::FRAC_1_PI;

use etendue_core::Spectral;
use etendue_spectra::{Spectrum, metal::ComplexIndex};
use glam::{Vec2, Vec3};

use super::interreflection::{self, RoughnessLoss};
use super::microfacet::{Distribution, Facets, MIRROR_ALPHA, half_vector, mirrored};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, Event, Passage, SurfaceModel};
use super::parameter::{Factor, Parameter, Reflectance, ShadingPoint, TextureCheck};
use super::{error::MaterialError, fresnel, gloss::Gloss};
use crate::textures::TextureId;

/// A metal, or another interface that light does not leave again.
#[derive(Clone, Debug, PartialEq)]
pub struct Conductor {
    index: ConductorIndex,
    alpha: Factor,
    distribution: Distribution,
    /// F̄, if multiple scattering is included.
    mean_fresnel: Option<MeanFresnel>,
}

/// F over all directions, by their cosines.
#[derive(Clone, Debug, PartialEq)]
enum MeanFresnel {
    /// At each wavelength.
    Spectrum(Spectrum),
    /// Of Schlick's approximation: F₀ + (1 − F₀)/21.
    Schlick,
}

/// A refractive index over wavelength.
#[derive(Clone, Debug, PartialEq)]
enum ConductorIndex {
    Complex(ComplexIndex),
    Real(Spectrum),
    /// Given by the reflectance at normal incidence only, the colours of a texture.
    Colour(Reflectance),
}

impl Conductor {
    /// A metal of complex index `index` and roughness `alpha` (GGX α, 0 to 1).
    ///
    /// # Errors
    /// If the roughness is outside 0–1 or the index is not a substance's (n² + k² must be positive and finite).
    pub fn new(index: ComplexIndex, alpha: impl Into<Factor>) -> Result<Self, MaterialError> {
        let alpha = alpha.into().checked_alpha()?;
        match (300_u16..=1100).find(|nm| !is_a_substance(&index, f32::from(*nm))) {
            Some(nm) => Err(MaterialError::Index { nm }),
            None => Ok(Self::from_index(ConductorIndex::Complex(index), alpha)),
        }
    }

    /// An interface of real refractive index `index` (1 to 4) and roughness `alpha` (GGX α, 0 to 1); light that enters is absorbed.
    ///
    /// # Errors
    /// If the roughness or the index is out of range.
    pub fn dielectric(index: Spectrum, alpha: impl Into<Factor>) -> Result<Self, MaterialError> {
        let alpha = alpha.into().checked_alpha()?;
        match (300_u16..=1100).find(|nm| !(1.0..=4.0).contains(&index.at(f32::from(*nm)))) {
            Some(nm) => Err(MaterialError::RealIndex { nm, n: index.at(f32::from(nm)) }),
            None => Ok(Self::from_index(ConductorIndex::Real(index), alpha)),
        }
    }

    /// A metal of roughness `alpha` (GGX α, 0 to 1) that reflects the colours of `texture` at normal incidence, and follows Schlick's
    /// approximation elsewhere.
    ///
    /// # Errors
    /// If the roughness is out of range.
    pub fn from_texture(texture: TextureId, alpha: impl Into<Factor>) -> Result<Self, MaterialError> {
        Ok(Self::from_index(ConductorIndex::Colour(Reflectance::Texture(texture)), alpha.into().checked_alpha()?))
    }

    fn from_index(index: ConductorIndex, alpha: Factor) -> Self {
        Self { index, alpha, distribution: Distribution::Ggx, mean_fresnel: None }
    }

    /// Sets another distribution of facets.
    #[must_use]
    pub fn with_distribution(self, distribution: Distribution) -> Self {
        Self { distribution, ..self }
    }

    /// Adds multiple scattering among facets.
    #[must_use]
    pub fn with_interreflection(self) -> Self {
        let mean = self.index.mean_fresnel();
        Self { mean_fresnel: Some(mean), ..self }
    }
}

impl SurfaceModel for Conductor {
    type Bsdf<'a, const N: usize> = ConductorBsdf<N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        let mut parameters = vec![Parameter::alpha(self.alpha)];
        if let ConductorIndex::Colour(reflectance) = &self.index {
            parameters.push(Parameter::Reflectance(reflectance));
        }
        parameters
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> ConductorBsdf<N> {
        let own_alpha = point.factor(self.alpha);
        let alpha = point.widened(own_alpha);
        let rough = alpha >= MIRROR_ALPHA;
        let fresnel = match &self.index {
            ConductorIndex::Complex(index) => {
                Fresnel::Complex(index.n.sample(point.wavelengths), index.k.sample(point.wavelengths))
            }
            ConductorIndex::Real(n) => Fresnel::Real(n.sample(point.wavelengths)),
            ConductorIndex::Colour(reflectance) => Fresnel::Schlick(point.reflectance(reflectance)),
        };
        let more = self.mean_fresnel.as_ref().filter(|_| rough).map(|mean| {
            let loss = interreflection::table(self.distribution).at_alpha(alpha);
            let mean = match (mean, fresnel) {
                (MeanFresnel::Spectrum(mean), _) => mean.sample(point.wavelengths),
                (
                    MeanFresnel::Schlick,
                    Fresnel::Schlick(normal) | Fresnel::Real(normal) | Fresnel::Complex(normal, _),
                ) => normal.map(|normal| normal + (1.0 - normal) / 21.0),
            };
            MultipleScattering { loss, tint: mean.map(|mean| loss.tint(mean)) }
        });
        let facets = rough.then(|| self.distribution.facets(alpha));
        ConductorBsdf { fresnel, facets, is_widened: alpha > own_alpha, more }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

fn is_a_substance(index: &ComplexIndex, nm: f32) -> bool {
    let (n, k) = (index.n.at(nm), index.k.at(nm));
    n >= 0.0 && k >= 0.0 && n * n + k * k > 1e-9 && (n * n + k * k) < 1e9
}

impl ConductorIndex {
    fn mean_fresnel(&self) -> MeanFresnel {
        let of = |fresnel: &dyn Fn(f32, f32) -> f32| {
            MeanFresnel::Spectrum(Spectrum::from_fn(|nm| mean_over_directions(|cos_i| fresnel(nm as f32, cos_i))))
        };
        match self {
            Self::Complex(index) => of(&|nm, cos_i| fresnel::conductor(cos_i, index.n.at(nm), index.k.at(nm))),
            Self::Real(n) => of(&|nm, cos_i| fresnel::dielectric(cos_i, n.at(nm))),
            Self::Colour(_) => MeanFresnel::Schlick,
        }
    }
}

/// 2 ∫ F μ dμ = ∫ F dμ², by the midpoint rule.
fn mean_over_directions(fresnel: impl Fn(f32) -> f32) -> f64 {
    const STEPS: usize = 64;
    let at = |i: usize| f64::from(fresnel(((i as f32 + 0.5) / STEPS as f32).sqrt()));
    (0..STEPS).map(at).sum::<f64>() / STEPS as f64
}

/// Indices at a path's wavelengths.
#[derive(Clone, Copy, Debug)]
enum Fresnel<const N: usize> {
    Complex(Spectral<N>, Spectral<N>),
    Real(Spectral<N>),
    /// Reflectance at normal incidence.
    Schlick(Spectral<N>),
}

/// Multiple scattering among facets.
#[derive(Clone, Copy, Debug)]
struct MultipleScattering<const N: usize> {
    loss: RoughnessLoss<'static>,
    /// F_ms.
    tint: Spectral<N>,
}

/// A rough interface at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct ConductorBsdf<const N: usize> {
    fresnel: Fresnel<N>,
    /// `None` for a mirror.
    facets: Option<Facets>,
    /// True if they are rougher than the surface.
    is_widened: bool,
    more: Option<MultipleScattering<N>>,
}

impl<const N: usize> ConductorBsdf<N> {
    /// The reflectance of a facet `m`; for widened facets that of the surface: their tilt spreads the reflected light, and does not change
    /// it otherwise.
    fn reflected(&self, wo: Vec3, m: Vec3) -> Spectral<N> {
        self.fresnel(if self.is_widened { wo.z } else { wo.dot(m) })
    }

    fn fresnel(&self, cos_i: f32) -> Spectral<N> {
        match self.fresnel {
            Fresnel::Complex(n, k) => Spectral::from_fn(|i| fresnel::conductor(cos_i, n[i], k[i])),
            Fresnel::Real(n) => n.map(|n| fresnel::dielectric(cos_i, n)),
            Fresnel::Schlick(normal) => {
                let rest = (1.0 - cos_i).clamp(0.0, 1.0);
                let fraction = (rest * rest) * (rest * rest) * rest;
                normal.map(|normal| normal + (1.0 - normal) * fraction)
            }
        }
    }

    /// Probability of sampling multiple scattering: approximately its fraction of the reflected light.
    fn multiple_scattering_fraction(&self, more: &MultipleScattering<N>, wo_loss: f32, wo: Vec3) -> f32 {
        let (again, once) = (more.tint.mean() * wo_loss, self.fresnel(wo.z).mean() * (1.0 - wo_loss));
        if again + once > 0.0 { again / (again + once) } else { 0.0 }
    }

    fn sample_both(
        &self,
        facets: Facets,
        more: &MultipleScattering<N>,
        wo: Vec3,
        choice: f32,
        u: Vec2,
    ) -> Option<BsdfSample<N>> {
        let fraction = self.multiple_scattering_fraction(more, more.loss.at(wo.z), wo);
        let wi = if choice < fraction { more.loss.sample(u) } else { mirrored(wo, facets.sample(wo, u)) };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.evaluate(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}

impl<const N: usize> BsdfModel<N> for ConductorBsdf<N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags { delta: self.facets.is_none(), transmits: false, has_parts: true }
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let Some(facets) = self.facets else { return BsdfValue::ZERO };
        let m = half_vector(wo, wi);
        let (once, pdf) = (self.reflected(wo, m) * facets.reflect(wo, wi, m), facets.reflect_pdf(wo, m));
        let Some(more) = &self.more else { return BsdfValue { value_cos: once, pdf } };
        let wo_loss = more.loss.at(wo.z);
        let fraction = self.multiple_scattering_fraction(more, wo_loss, wo);
        BsdfValue {
            value_cos: once + more.tint * more.loss.value_cos(wo_loss, wi),
            pdf: pdf * (1.0 - fraction) + fraction * more.loss.pdf(wi.z),
        }
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let Some(facets) = self.facets else { return Gloss::MATT };
        let diffuse = self.more.as_ref().map_or(0.0, |more| more.tint.mean() * more.loss.at(wo.z) * FRAC_1_PI);
        Gloss::from_diffuse(diffuse).with(facets.gloss(wo, self.fresnel(1.0).mean()))
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let Some(facets) = self.facets else { return Some(BsdfSample::mirror(wo, self.fresnel(wo.z))) };
        if let Some(more) = &self.more {
            return self.sample_both(facets, more, wo, choice, u);
        }
        let m = facets.sample(wo, u);
        let wi = mirrored(wo, m);
        (wi.z > 0.0).then(|| BsdfSample {
            wi,
            weight: self.reflected(wo, m) * facets.weight(wo, wi),
            pdf: facets.reflect_pdf(wo, m),
            event: Event::Scatter,
        })
    }
}
