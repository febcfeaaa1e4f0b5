//! Selection of a light.
//!
//! Lights in the scene and lights at infinity share the samples by the irradiances that a receiver can expect of them. For lights in the scene this
//! is the estimate of the tree. For lights at infinity it is the irradiance of the suns that the surface faces, and the mean irradiance of the
//! surroundings. Neither group receives less than [`FLOOR`] if it can contribute at all, since both numbers are estimates.
//!
//! Within the scene the tree decides (`tree/`); at infinity suns and surroundings are weighted by irradiance. Of surroundings next to suns only
//! bright patches count, and the part of the rest that exceeds the irradiance of the suns (`patches.rs`): scattered rays hit uniform surroundings
//! often enough. A sample that falls on a sun behind the receiver's surface evaluates nothing, so that surfaces in shade do not sample the
//! surroundings more often either. Figures are in `docs/decisions/surroundings.md`.

use super::tree::{DIFFUSE_FRACTION, LightBounds, LightTree, TreeQuery, TreeStart};
use super::{LightSampleContext, light_sample::LampIrradiance, sun::Sun};
use crate::ALL_EFFECTS;

/// Minimum fraction of the samples for lights in the scene against those at infinity, and the reverse.
const FLOOR: f32 = 0.05;

/// A light among all lights of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightId {
    /// A light in the scene, by its index.
    Local(usize),
    /// A sun, by its index.
    Sun(usize),
    /// The surroundings.
    Environment,
}

/// A light that was sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SampledLight {
    pub(super) id: LightId,
    pub(super) probability: f32,
}

/// A sun, and the irradiance of a surface that faces it, W·m⁻²·nm⁻¹.
#[derive(Clone, Debug)]
pub(super) struct WeightedSun {
    pub(super) sun: Sun,
    pub(super) irradiance: f32,
}

/// Samples a light for a receiver.
#[derive(Clone, Debug)]
pub(super) struct LightSampler {
    tree: Option<LightTree>,
    suns: Vec<WeightedSun>,
    /// Irradiance of the surroundings if they are sampled, W·m⁻²·nm⁻¹.
    environment: f32,
    /// True if suns or surroundings can be sampled.
    has_distant: bool,
}

impl LightSampler {
    /// Selection among lights in the scene, suns, and surroundings of a mean irradiance (0 if they are not sampled).
    pub(super) fn new(local: &[LightBounds], suns: Vec<WeightedSun>, environment: f32) -> Self {
        let has_distant = environment > 0.0 || suns.iter().any(|sun| sun.irradiance > 0.0);
        Self { tree: LightTree::new(local), suns, environment, has_distant }
    }

    /// True if any light can be sampled.
    pub(super) fn is_possible(&self) -> bool {
        self.tree.is_some() || self.has_distant
    }

    /// True if there is more than one light to choose from.
    pub(super) fn has_choice(&self) -> bool {
        let near = self.tree.as_ref().map_or(0, LightTree::len);
        near + self.suns.len() + usize::from(self.environment > 0.0) > 1
    }

    /// The light selected by `u` in [0, 1), and its probability; `None` if nothing reaches the receiver. The start of the receiver
    /// ([`LightSampler::start`], [`LightSampler::local_fraction`]) serves all its samples.
    pub(super) fn sample<F: Fn(u32) -> LampIrradiance>(
        &self,
        query: &TreeQuery<'_, F>,
        start: &TreeStart,
        local: f32,
        u: f64,
    ) -> Option<SampledLight> {
        match &self.tree {
            Some(tree) if u < f64::from(local) => {
                let (light, probability) = tree.sample(query, start, u / f64::from(local))?;
                Some(SampledLight { id: LightId::Local(light), probability: local * probability })
            }
            _ => {
                let rest = (u - f64::from(local)) / (1.0 - f64::from(local));
                let light = self.sample_distant(query.receiver, rest as f32)?;
                Some(SampledLight { probability: (1.0 - local) * light.probability, ..light })
            }
        }
    }

    /// `None` if the sample falls on a sun that the receiver faces away from.
    fn sample_distant(&self, receiver: &LightSampleContext, u: f32) -> Option<SampledLight> {
        let suns = (0..self.suns.len()).map(LightId::Sun);
        let lights = suns.chain((self.environment > 0.0).then_some(LightId::Environment));
        let (mut rest, mut sampled) = (u, None);
        for id in lights {
            let probability = self.distant_probability(id, receiver);
            if probability > 0.0 {
                sampled = Some(SampledLight { id, probability });
                if rest < probability {
                    break;
                }
                rest -= probability;
            }
        }
        sampled.filter(|light| self.reaches(light.id, receiver))
    }

    /// The probability of a light at infinity among those at infinity: by its weight, and to [`DIFFUSE_FRACTION`] by its weight for a diffuse
    /// receiver. Suns that the receiver faces away from keep their probabilities.
    fn distant_probability(&self, light: LightId, receiver: &LightSampleContext) -> f32 {
        let raised = self.weighted_distant_probability(light, receiver);
        if receiver.gloss.is_none() {
            return raised;
        }
        let diffuse = LightSampleContext { gloss: None, ..*receiver };
        (1.0 - DIFFUSE_FRACTION) * raised + DIFFUSE_FRACTION * self.weighted_distant_probability(light, &diffuse)
    }

    fn weighted_distant_probability(&self, light: LightId, receiver: &LightSampleContext) -> f32 {
        let counts = match light {
            LightId::Sun(i) => self.sun_weight(i, receiver),
            LightId::Environment => self.environment,
            LightId::Local(_) => 0.0,
        };
        let total = (0..self.suns.len()).map(|i| self.sun_weight(i, receiver)).sum::<f32>() + self.environment;
        if counts > 0.0 { counts / total } else { 0.0 }
    }

    /// The probability with which [`LightSampler::sample`] returns a light.
    pub(super) fn probability<F: Fn(u32) -> LampIrradiance>(&self, query: &TreeQuery<'_, F>, light: LightId) -> f32 {
        let start = self.start(query);
        let local = self.local_fraction(query, &start);
        match (light, &self.tree) {
            (LightId::Local(_), None) => 0.0,
            (LightId::Local(i), Some(tree)) => local * tree.probability(query, &start, i),
            _ if !self.reaches(light, query.receiver) => 0.0,
            _ => (1.0 - local) * self.distant_probability(light, query.receiver),
        }
    }

    /// The receiver's start in the tree. It is large, so it is built in its final place.
    #[inline(always)]
    pub(super) fn start<F: Fn(u32) -> LampIrradiance>(&self, query: &TreeQuery<'_, F>) -> TreeStart {
        match &self.tree {
            Some(tree) => tree.start(query),
            None => TreeStart::Only,
        }
    }

    /// The fraction of the samples for lights in the scene.
    #[inline(always)]
    pub(super) fn local_fraction<F: Fn(u32) -> LampIrradiance>(
        &self,
        query: &TreeQuery<'_, F>,
        start: &TreeStart,
    ) -> f32 {
        let Some(tree) = &self.tree else { return 0.0 };
        if !(ALL_EFFECTS && self.has_distant) {
            return 1.0;
        }
        let distant = self.distant_irradiance(query.receiver);
        if distant <= 0.0 {
            return 1.0;
        }
        let local = tree.irradiance(query, start) as f32;
        if local > 0.0 { (1.0 / (1.0 + distant / local)).clamp(FLOOR, 1.0 - FLOOR) } else { 0.0 }
    }

    /// Irradiance of the lights at infinity that may reach the receiver.
    fn distant_irradiance(&self, receiver: &LightSampleContext) -> f32 {
        let reaching = (0..self.suns.len()).filter(|i| self.reaches(LightId::Sun(*i), receiver));
        reaching.map(|i| self.sun_weight(i, receiver)).sum::<f32>() + self.environment
    }

    /// True if the receiver faces a light at infinity.
    fn reaches(&self, light: LightId, receiver: &LightSampleContext) -> bool {
        match light {
            LightId::Sun(i) => receiver.normal == glam::Vec3::ZERO || self.suns[i].sun.rises_over(receiver.normal),
            LightId::Environment | LightId::Local(_) => true,
        }
    }

    /// The weight of a sun for a receiver that faces it.
    fn sun_weight(&self, i: usize, receiver: &LightSampleContext) -> f32 {
        let WeightedSun { sun, irradiance } = &self.suns[i];
        *irradiance * (1.0 + receiver.glossy(sun.direction(), sun.sin()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::Spectrum;
    use glam::{DVec3, Vec3};

    /// Fractions of samples that fall on a sun and on surroundings of a third of its irradiance, and their probabilities, at a receiver.
    #[test]
    fn a_sun_behind_the_surface_keeps_its_share_of_the_samples() {
        let sun = Sun::from_radiance(DVec3::Z, 0.5, Spectrum::constant(1.0)).expect("a sun");
        let sampler = LightSampler::new(&[], vec![WeightedSun { sun, irradiance: 3.0 }], 1.0);
        for (normal, of_sun) in [(Vec3::Z, 0.75), (Vec3::ZERO, 0.75), (Vec3::NEG_Z, 0.0)] {
            let receiver = LightSampleContext::diffuse(Vec3::ZERO, normal);
            let query = TreeQuery { receiver: &receiver, lamp: |_| LampIrradiance::default() };
            let start = sampler.start(&query);
            let local = sampler.local_fraction(&query, &start);
            let mut counts = [0; 3];
            for i in 0..1000 {
                match sampler.sample(&query, &start, local, (f64::from(i) + 0.5) / 1000.0) {
                    Some(SampledLight { id: LightId::Sun(0), probability }) => {
                        counts[0] += usize::from(probability == 0.75);
                    }
                    Some(SampledLight { id: LightId::Environment, probability }) => {
                        counts[1] += usize::from(probability == 0.25);
                    }
                    other => counts[2] += usize::from(other.is_none()),
                }
            }
            let sun_draws = (of_sun * 1000.0) as usize;
            assert_eq!(counts, [sun_draws, 250, 750 - sun_draws], "{normal}");
            assert_eq!(sampler.probability(&query, LightId::Sun(0)), of_sun);
            assert_eq!(sampler.probability(&query, LightId::Environment), 0.25);
        }
    }
}
