//! Photon shot noise: photo-electrons are counted, and counts fluctuate.
//!
//! k ~ Poisson(μ), μ the mean photo-electrons of the pixel during the exposure; exact at every mean. Random numbers: `NoiseDraw::Shot` of the pixel.
//! Left out: several electrons per photon (below 400 nm).

use etendue_core::quantity::{Charge, MeanElectrons};
use etendue_core::random::{NoiseDraw, NoiseKey, Pixel};
use etendue_core::{EffectStatus, KeyChange, KnownError};

use crate::effect::{Context, Effect, NOISE_OFF, Row, RowConversion, SensorFacts, SignalLevels};
use crate::{capture::Operation, check::Checks, random::Poisson, signal_breakdown::SignalComponent};

/// Photon shot noise; it has no parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShotNoise;

impl ShotNoise {
    /// Counting, prepared; `None` if charge equals its mean.
    pub(crate) fn prepare(self, context: &Context) -> Option<PreparedShotNoise> {
        let counted = self.status(&context.facts, &context.operation).is_modelled();
        counted.then(|| PreparedShotNoise { key: context.noise(NoiseDraw::Shot) })
    }
}

impl Effect for ShotNoise {
    const NAME: &'static str = "shot noise";
    const KEY: &'static str = "sensor.noise";

    fn check(&self, _: &SensorFacts, _: &mut Checks) {}

    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus {
        if !facts.noise {
            EffectStatus::LeftOut(NOISE_OFF.into())
        } else if operation.exposure_s == 0.0 {
            EffectStatus::LeftOut("the exposure is zero: no photon is counted".into())
        } else {
            EffectStatus::Modelled("photo-electrons are Poisson distributed, sampled exactly at every mean".into())
        }
    }

    /// The key disables all temporal noise.
    fn left_out_by(&self) -> Vec<KeyChange> {
        vec![KeyChange { key: Self::KEY, value: Some("false") }]
    }

    fn errors_without(&self, _: &SensorFacts, levels: &SignalLevels) -> Vec<KnownError> {
        let SignalLevels { grey_e, dark_variance_e2 } = levels;
        let value = 100.0 * grey_e / (grey_e + dark_variance_e2);
        vec![KnownError { quantity: "missing variance at mid-grey", value, unit: "%" }]
    }
}

/// Converts mean electrons to charge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PreparedShotNoise {
    key: NoiseKey,
}

impl RowConversion for PreparedShotNoise {
    type Input = MeanElectrons;
    type Output = Charge;
    const COMPONENT: SignalComponent = SignalComponent::Shot;

    /// Replaces means (finite, not negative) by counts.
    fn convert<'a>(&self, row: Row<'a, MeanElectrons>) -> Row<'a, Charge> {
        for (x, e) in row.values.iter_mut().enumerate() {
            if let Some(poisson) = Poisson::new(*e) {
                *e = poisson.sample(&mut self.key.stream(Pixel { x: x as u32, y: row.y }));
            }
        }
        row.counted()
    }
}
