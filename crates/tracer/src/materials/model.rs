//! The interface of a scattering model: once for all points ([`SurfaceModel`]), and at one point for the wavelengths of one path ([`BsdfModel`]).
//! `surfaces!` forwards every call to the model by a `match`.

use etendue_core::Spectral;
use etendue_spectra::Spectrum;
use glam::{Vec2, Vec3};

use super::parameter::{Parameter, ShadingPoint, TextureCheck};
use super::{error::MaterialError, gloss::Gloss};

/// A model of scattering with its parameters: a row of `surfaces!`.
pub(super) trait SurfaceModel {
    /// The model at one point.
    type Bsdf<'a, const N: usize>: BsdfModel<N>
    where
        Self: 'a;

    /// Every parameter that may be a texture.
    fn parameters(&self) -> Vec<Parameter<'_>>;

    /// Passage of light behind the surface, other than by scattering.
    fn passage(&self) -> Passage<'_>;

    /// Evaluates textures and spectra at a point, once for all calls there.
    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> Self::Bsdf<'_, N>;

    /// Refuses parameters, each within its range, with which more would be reflected or transmitted than arrives. There is no default: a
    /// model that cannot gain energy returns `Ok(())`.
    fn check_energy(&self, check: &TextureCheck<'_>) -> Result<(), MaterialError>;

    /// The fraction of light that goes straight on, 0 to 1, at the cosine of incidence `cos` in (0, 1]: zero unless the passage is
    /// [`Passage::Straight`].
    fn straight_transmittance<const N: usize>(&self, point: &ShadingPoint<'_, N>, cos: f32) -> Spectral<N>;
}

/// Passage of light behind a surface, other than by scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Passage<'a> {
    /// No passage.
    None,
    /// Straight passage, as if there were no surface ([`super::Event::Null`]).
    Straight,
    /// Entry into the solid that the surface bounds. Its absorption coefficient, 1/m; `None` if it absorbs nothing.
    Solid(Option<&'a Spectrum>),
}

/// A model at one point, for the wavelengths of one path: the contract is that of [`super::Bsdf`].
pub(super) trait BsdfModel<const N: usize>: Copy {
    /// Direction-independent properties.
    fn flags(&self) -> BsdfFlags;

    /// Value and density of a pair of directions, wo.z > 0; wi.z > 0 too unless the flags say `transmits`.
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N>;

    /// Data for light selection, wo.z > 0: [`Gloss::MATT`] if no lobe is narrow.
    fn gloss(&self, wo: Vec3) -> Gloss;

    /// Samples a direction for light to come from, wo.z > 0; `None` if the light is absorbed. `choice` selects a lobe, `u` a direction;
    /// both are uniform in [0, 1).
    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>>;
}

/// Direction-independent properties at a point. There is no default: a model states each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BsdfFlags {
    /// Light continues in exact directions only, so that light sampling is useless.
    pub(super) delta: bool,
    /// Light may come from behind (wi.z < 0) by a finite density.
    pub(super) transmits: bool,
    /// [`BsdfModel::sample`] uses the number that selects a lobe.
    pub(super) has_parts: bool,
}

impl BsdfFlags {
    /// Flags of a model that reflects by a finite density through several lobes.
    pub(super) const LOBES: Self = Self { delta: false, transmits: false, has_parts: true };
}

/// Value and density of a BSDF for a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue<const N: usize> {
    /// bsdf × |cos θᵢ|, 1/sr.
    pub value_cos: Spectral<N>,
    /// Density with which sampling would give this `wi`, 1/sr.
    pub pdf: f32,
}

impl<const N: usize> BsdfValue<N> {
    /// No light along this pair of directions.
    pub const ZERO: Self = Self { value_cos: Spectral::ZERO, pdf: 0.0 };
}

/// Outcome of a path at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Scattered, by a finite density.
    Scatter,
    /// Reflected or refracted in the one exact direction.
    Specular,
    /// Passed straight on, as if there were no surface: no scattering event. The path keeps its direction.
    Null,
}

/// A direction sampled from a BSDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample<const N: usize> {
    /// Direction that light comes from; unit, never in the surface's plane.
    pub wi: Vec3,
    /// bsdf × |cos θᵢ| / pdf; for an exact direction its reflectance or transmittance over the probability of choosing it.
    pub weight: Spectral<N>,
    /// Density of `wi`, 1/sr; 0 and without meaning for an exact direction.
    pub pdf: f32,
    pub event: Event,
}

impl<const N: usize> BsdfSample<N> {
    pub(super) fn mirror(wo: Vec3, weight: Spectral<N>) -> Self {
        Self { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight, pdf: 0.0, event: Event::Specular }
    }
}

/// Probabilities of `K` lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DiscreteSampler<const K: usize>([f32; K]);

impl<const K: usize> DiscreteSampler<K> {
    /// Probabilities in proportion to `shares` (0 or more); `None` if all are zero.
    pub(super) fn new(fractions: [f32; K]) -> Option<Self> {
        let total: f32 = fractions.iter().sum();
        (total > 0.0).then(|| Self(fractions.map(|s| s / total)))
    }

    /// Probability of lobe `k`.
    pub(super) fn probability(&self, k: usize) -> f32 {
        self.0[k]
    }

    /// The lobe selected by `choice` in [0, 1); never one of zero probability.
    pub(super) fn sample(&self, choice: f32) -> usize {
        let mut left = choice;
        let mut last = 0;
        for (k, p) in self.0.iter().enumerate().filter(|(_, p)| **p > 0.0) {
            last = k;
            if left < *p {
                break;
            }
            left -= p;
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lobes_are_sampled_by_weight() {
        let discrete_sampler = DiscreteSampler::new([0.0, 1.0, 0.0, 3.0, 0.0]).expect("weights");
        let mut counts = [0; 5];
        (0..1000).for_each(|i| counts[discrete_sampler.sample((i as f32 + 0.5) / 1000.0)] += 1);
        assert_eq!(counts, [0, 250, 0, 750, 0]);
        assert_eq!(discrete_sampler.sample(0.999_999_94), 3);
        assert_eq!(discrete_sampler.probability(3), 0.75);
        assert!(DiscreteSampler::new([0.0; 3]).is_none());
    }
}
