//! Dead pixels: they hold no charge, regardless of the light.
//!
//! e ← 0 for a fraction of pixels, after the full well: they still drain and pass overflow. The selection belongs to the unit. Random numbers:
//! `Dead`. Left out: pixels stuck at other values, dead rows and columns, clusters.

use etendue_core::random::{NoiseDraw, NoiseKey};
use etendue_core::{EffectStatus, KeyChange, KnownError, quantity::Charge};

use crate::effect::{Action, Context, Effect, Memory, QuantityEffect, Row, RowEffect, SensorFacts, SignalLevels};
use crate::{capture::Operation, check::Checks, random::pattern, signal_breakdown::SignalComponent};

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeadPixels {
    /// Fraction of pixels that hold no charge, 0 to 1; 0: none.
    pub fraction: f64,
}

impl Effect for DeadPixels {
    const NAME: &'static str = "dead pixels";
    const KEY: &'static str = "sensor.non_uniformity.dead_fraction";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.fraction("non_uniformity.dead_fraction", self.fraction);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        match self.fraction {
            0.0 => EffectStatus::NotDescribed,
            fraction => EffectStatus::Modelled(format!("{fraction} of pixels collect no charge")),
        }
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        vec![KeyChange::zero(Self::KEY)]
    }

    fn errors_without(&self, _: &SensorFacts, _: &SignalLevels) -> Vec<KnownError> {
        vec![KnownError { quantity: "missing dead pixels", value: 100.0 * self.fraction, unit: "%" }]
    }
}

impl QuantityEffect for DeadPixels {
    type Signal = Charge;
    const COMPONENT: SignalComponent = SignalComponent::FixedPattern;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Charge> {
        Action::rows(PreparedDeadPixels { fraction: self.fraction, key: context.pattern(NoiseDraw::Dead) })
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PreparedDeadPixels {
    fraction: f64,
    key: NoiseKey,
}

impl RowEffect<Charge> for PreparedDeadPixels {
    fn apply(&self, row: &mut Row<'_, Charge>) {
        let charges = &mut *row.values;
        pattern::each(self.key, row.y, self.fraction, charges.len(), |x, _| charges[x] = 0.0);
    }
}

#[cfg(test)]
mod tests {
    use crate::capture::FrameAddress;
    use crate::frame::tests::{ADDRESS, quiet, run};
    use etendue_core::Plane;

    #[test]
    fn a_fraction_of_pixels_is_dark_in_every_frame() {
        let mut p = quiet();
        p.charge.dead_pixels.fraction = 0.02;
        let means = Plane::filled(200, 200, 100.0);
        let raw = run(&p, &means, ADDRESS);
        let dead = raw.plane.samples().iter().filter(|dn| **dn == 0).count() as f64;
        // 800 ± 28; four of those.
        assert!((dead - 800.0).abs() < 112.0, "{dead}");
        assert!(raw.plane.samples().iter().all(|dn| *dn == 0 || *dn == 100));
        assert_eq!(raw.plane, run(&p, &means, FrameAddress { frame: 9, ..ADDRESS }).plane);
    }
}
