//! Deviations added to voltages by the read-out: the offset pattern (DSNU) and read noise.
//!
//! Dark-signal non-uniformity (DSNU) of the read-out: offsets that are present at zero exposure time.
//!
//! e ← e + d, d normal with a white, a row and a column part, in electrons (EMVA 1288 release 4). The pattern belongs to the unit. Random numbers:
//! `PixelOffset`, `RowOffset`, `ColumnOffset`. The part that grows with the exposure is the spread of the [dark current](super::dark_current).
//!
//! Read noise: noise added by the read-out chain, in electrons at the input of the ADC.
//!
//! e ← e + d, d normal with a white, a row and a column part, new in every capture; the result may be negative, which the black level absorbs. Random
//! numbers: `Read` of the pixel, `RowRead`, `ColumnRead`. Left out: spread of σ over pixels (see [`rts_noise`](super::two_level) for its tail),
//! correlation along a row (1/f).

use etendue_core::{EffectStatus, KeyChange, KnownError, quantity::Voltage, random::NoiseDraw};

use crate::effect::{
    Action, Context, Effect, Memory, NOISE_OFF, QuantityEffect, Row, RowEffect, SensorFacts, SignalLevels,
};
use crate::random::pattern::{Deviations, Sigmas};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Deviations of voltages, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct VoltageDeviations(pub(super) Deviations);

impl RowEffect<Voltage> for VoltageDeviations {
    fn apply(&self, row: &mut Row<'_, Voltage>) {
        let voltages = &mut *row.values;
        self.0.for_row(row.y, voltages.len(), |x, d| voltages[x] += d);
    }
}

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
        EffectStatus::Modelled(format!("standard deviation of the offsets: {}", sigmas.described(" e⁻")))
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
        vec![KnownError { quantity: "missing DSNU", value, unit: "e⁻" }]
    }
}

impl QuantityEffect for OffsetPattern {
    type Signal = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::FixedPattern;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Voltage> {
        let purposes = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let key = |purpose| context.pattern(purpose);
        Action::rows(VoltageDeviations(Deviations::new(self.sigmas(), purposes, key, context.width)))
    }
}

/// Standard deviations, e⁻, 0 or more.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadNoise {
    /// From pixel to pixel; captures may have their own.
    pub white_e: f64,
    /// Common to a row.
    pub row_e: f64,
    /// Common to a column.
    pub column_e: f64,
}

impl ReadNoise {
    fn sigmas(&self, operation: &Operation) -> Sigmas {
        Sigmas { white: operation.read_noise_e, row: self.row_e, column: self.column_e }
    }
}

impl Effect for ReadNoise {
    const NAME: &'static str = "read noise";
    const KEY: &'static str = "sensor.read_noise_e";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.not_negative("read_noise_e", self.white_e);
        checks.not_negative("row_noise_e", self.row_e);
        checks.not_negative("column_noise_e", self.column_e);
    }

    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus {
        if self.sigmas(operation).is_zero() {
            EffectStatus::LeftOut("the read noise is 0 e⁻".into())
        } else if facts.noise {
            let part = |name, e: f64| if e > 0.0 { format!(", {e} e⁻ common to a {name}") } else { String::new() };
            let common = part("row", self.row_e) + &part("column", self.column_e);
            EffectStatus::Modelled(format!("standard deviation {} e⁻, Gaussian{common}", operation.read_noise_e))
        } else {
            EffectStatus::LeftOut(NOISE_OFF.into())
        }
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        let common = [("sensor.row_noise_e", self.row_e), ("sensor.column_noise_e", self.column_e)];
        let common = common.into_iter().filter(|(_, sigma_e)| *sigma_e != 0.0);
        std::iter::once(KeyChange::zero(Self::KEY)).chain(common.map(|(key, _)| KeyChange::removed(key))).collect()
    }

    fn errors_without(&self, _: &SensorFacts, levels: &SignalLevels) -> Vec<KnownError> {
        let SignalLevels { grey_e, dark_variance_e2 } = levels;
        let variance_e2 = self.white_e * self.white_e + self.row_e * self.row_e + self.column_e * self.column_e;
        let lost = |quantity, of_e2: f64| KnownError { quantity, value: 100.0 * variance_e2 / of_e2, unit: "%" };
        vec![
            lost("missing variance at mid-grey", grey_e + dark_variance_e2),
            lost("missing variance in the dark", *dark_variance_e2),
        ]
    }
}

impl QuantityEffect for ReadNoise {
    type Signal = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::Read;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Voltage> {
        let purposes = [NoiseDraw::Read, NoiseDraw::RowRead, NoiseDraw::ColumnRead];
        let key = |purpose| context.noise(purpose);
        Action::rows(VoltageDeviations(Deviations::new(self.sigmas(&context.operation), purposes, key, context.width)))
    }
}
