//! Dark-signal non-uniformity (DSNU) of the read-out: offsets that are there after no time at all.
//!
//! e ← e + d, d normal with a white, a row and a column part, in electrons (EMVA 1288 release 4). The pattern is the specimen's.
//! Draws: `PixelOffset`, `RowOffset`, `ColumnOffset`. What grows with the exposure is the spread of the
//! [dark current](super::dark_current).

use super::voltage_deviations::VoltageDeviations;
use crate::check::Checks;
use crate::effect::{Action, Context, Effect, EffectOn, Memory, SensorFacts, SignalLevels};
use crate::operation::Operation;
use crate::random::pattern::{Deviations, Sigmas};
use crate::signal_breakdown::SignalComponent;
use etendue_core::quantity::Voltage;
use etendue_core::random::NoiseDraw;
use etendue_core::{EffectStatus, KeyChange, KnownError};

/// Standard deviations of the offsets, e⁻, 0 or more; 0: none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OffsetPattern {
    /// From pixel to pixel.
    pub white_e: f64,
    /// From row to row.
    pub row_e: f64,
    /// From column to column.
    pub column_e: f64,
}

impl OffsetPattern {
    fn sigmas(self) -> Sigmas {
        Sigmas { white: self.white_e, row: self.row_e, column: self.column_e }
    }
}

impl Effect for OffsetPattern {
    const NAME: &'static str = "offset non-uniformity";
    const KEY: &'static str = "sensor.non_uniformity.dsnu_e";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.not_negative("non_uniformity.dsnu_e", self.white_e);
        checks.not_negative("non_uniformity.dsnu_row_e", self.row_e);
        checks.not_negative("non_uniformity.dsnu_column_e", self.column_e);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        let sigmas = self.sigmas();
        if sigmas.is_zero() {
            return EffectStatus::NotDescribed;
        }
        EffectStatus::Modelled(format!("offsets differ: {}", sigmas.described(" e⁻")))
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        KeyChange::zeros([
            (Self::KEY, self.white_e),
            ("sensor.non_uniformity.dsnu_row_e", self.row_e),
            ("sensor.non_uniformity.dsnu_column_e", self.column_e),
        ])
    }

    fn errors_without(&self, _: &SensorFacts, _: &SignalLevels) -> Vec<KnownError> {
        let value = (self.white_e * self.white_e + self.row_e * self.row_e + self.column_e * self.column_e).sqrt();
        vec![KnownError { quantity: "missing spread of offsets", value, unit: "e⁻" }]
    }
}

impl EffectOn for OffsetPattern {
    type On = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::FixedPattern;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Voltage> {
        let draws = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let key = |draw| context.pattern(draw);
        Action::rows(VoltageDeviations(Deviations::new(self.sigmas(), draws, key, context.width)))
    }
}
