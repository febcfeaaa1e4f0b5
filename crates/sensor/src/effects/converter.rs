//! The ADC: electrons to digital numbers.
//!
//! DN = clip(round(black level + K e), 0, 2ᵇⁱᵗˢ − 1), then, with a digital gain g ≠ 1, DN ← clip(round(black + g (DN − black))). K includes the
//! analogue gain. Rounding is to the nearest, halves to even, without dither: dither and rounding together would double the quantisation noise of
//! 1/12 DN² (EMVA 1288). The black level is added before rounding and clipping, so read noise below zero survives. Left out: missing codes, integral
//! and differential non-linearity.

use etendue_core::{EffectStatus, KeyChange, KnownError, quantity::Voltage};

use crate::effect::{Effect, Row, SensorFacts, SignalLevels};
use crate::{capture::Operation, check::Checks};

/// The ADC at the gain of a capture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Adc {
    /// Digital numbers per electron, analogue gain included.
    pub(crate) gain_dn_e: f64,
    /// Digital number of zero charge, DN.
    pub(crate) black_level_dn: f64,
    /// Bits of its numbers, 1 to 24.
    pub(crate) bits: u32,
    /// Factor on digital numbers above black.
    pub(crate) digital_gain: f64,
}

/// The largest digital number of an ADC; infinite beyond the supported number of bits.
pub(crate) fn largest_dn(bits: u32) -> f64 {
    if bits <= 24 { f64::from((1_u32 << bits) - 1) } else { f64::INFINITY }
}

impl Effect for Adc {
    const NAME: &'static str = "ADC";
    const KEY: &'static str = "sensor.bits";

    /// Each factor of the gain is checked as described.
    fn check(&self, facts: &SensorFacts, checks: &mut Checks) {
        checks.positive("gain_dn_per_e", facts.gain_dn_e);
        checks.positive("analogue_gain", facts.analogue_gain);
        checks.positive("digital_gain", self.digital_gain);
        let black = self.black_level_dn;
        let is_below = black >= 0.0 && black < largest_dn(self.bits);
        checks.legal("black_level_dn", black, is_below, "a number from 0 to below the ADC's maximum");
        let is_bits = (1..=24).contains(&self.bits);
        checks.legal("bits", f64::from(self.bits), is_bits, "a whole number from 1 to 24");
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        let digital = match self.digital_gain {
            1.0 => String::new(),
            gain => format!(", then a digital gain of {gain}"),
        };
        let Self { gain_dn_e, black_level_dn, bits, .. } = self;
        EffectStatus::Modelled(format!("{gain_dn_e} DN/e⁻, black level {black_level_dn} DN, {bits} bits{digital}"))
    }

    /// A sensor always has an ADC.
    fn left_out_by(&self) -> Vec<KeyChange> {
        Vec::new()
    }

    /// Rounding to integers: a standard deviation of 1/√12 of a step.
    fn errors_without(&self, _: &SensorFacts, _: &SignalLevels) -> Vec<KnownError> {
        vec![KnownError { quantity: "missing quantisation noise", value: 1.0 / 12.0_f64.sqrt(), unit: "DN" }]
    }
}

impl Adc {
    /// The digital numbers of a row.
    pub(crate) fn convert(&self, row: &Row<'_, Voltage>, numbers: &mut [u32]) {
        numbers.iter_mut().zip(&*row.values).for_each(|(dn, e)| *dn = self.digital_number(*e));
    }

    /// The digital number of a voltage.
    fn digital_number(&self, electrons: f64) -> u32 {
        let dn = self.rounded(self.black_level_dn + self.gain_dn_e * electrons);
        if self.digital_gain == 1.0 {
            return dn as u32;
        }
        self.rounded(self.black_level_dn + self.digital_gain * (dn - self.black_level_dn)) as u32
    }

    fn rounded(&self, dn: f64) -> f64 {
        dn.round_ties_even().clamp(0.0, largest_dn(self.bits))
    }

    /// The electrons of a digital number.
    pub(crate) fn electrons(&self, dn: f64) -> f64 {
        (dn - self.black_level_dn) / (self.digital_gain * self.gain_dn_e)
    }

    /// The digital number of a voltage without rounding, up to the largest.
    pub(crate) fn level_dn(&self, electrons: f64) -> f64 {
        let largest = largest_dn(self.bits);
        let before = (self.black_level_dn + self.gain_dn_e * electrons).min(largest);
        (self.black_level_dn + self.digital_gain * (before - self.black_level_dn)).min(largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_to_even_and_clips_after_the_offset() {
        let mut converter = Adc { gain_dn_e: 0.5, black_level_dn: 10.0, bits: 8, digital_gain: 1.0 };
        let dn = [-100.0, -20.0, -3.0, 0.0, 1.0, 3.0, 4.0, 490.0, 1e12].map(|e| converter.digital_number(e));
        assert_eq!(dn, [0, 0, 8, 10, 10, 12, 12, 255, 255]);
        converter.digital_gain = 2.0;
        let dn = [-3.0, 0.0, 4.0, 1e12].map(|e| converter.digital_number(e));
        assert_eq!(dn, [6, 10, 14, 255]);
        converter.digital_gain = 1.0;
        converter.bits = 24;
        assert_eq!(converter.digital_number(1e12), 16_777_215);
    }
}
