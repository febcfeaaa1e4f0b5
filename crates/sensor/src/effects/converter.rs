//! The converter: electrons to digital numbers.
//!
//! DN = clip(round(black level + K e), 0, 2ᵇⁱᵗˢ − 1), then, where there is a digital gain g ≠ 1,
//! DN ← clip(round(black + g (DN − black))). K includes the analogue gain. Rounding is to the nearest, halves to even, without
//! dither: dither and rounding together would double the quantisation noise of 1/12 DN² (EMVA 1288). The black level is added
//! before rounding and clipping, so read noise below zero survives.
//! Left out: missing codes, integral and differential non-linearity of the converter.

use super::Verdict;
use crate::operation::{Context, Operation};
use crate::parameters::SensorParameters;

pub(super) fn need(p: &SensorParameters, operation: &Operation) -> (Verdict, String) {
    let read_out = &p.read_out;
    let digital = match read_out.digital_gain {
        1.0 => String::new(),
        gain => format!(", then a digital gain of {gain}"),
    };
    let (gain, black, bits) = (operation.gain_dn_e, read_out.black_level_dn, read_out.bits);
    (Verdict::Required, format!("{gain} DN/e⁻, black at {black} DN, {bits} bits{digital}"))
}

/// The converter, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Converter {
    gain_dn_e: f64,
    black_level_dn: f64,
    largest_dn: f64,
    digital_gain: f64,
}

impl Converter {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        Self::of(context.p, &context.operation)
    }

    pub(crate) fn of(p: &SensorParameters, operation: &Operation) -> Self {
        let read_out = &p.read_out;
        Self {
            gain_dn_e: operation.gain_dn_e,
            black_level_dn: read_out.black_level_dn,
            largest_dn: p.largest_dn(),
            digital_gain: read_out.digital_gain,
        }
    }

    /// The digital number of a voltage.
    pub(crate) fn digital_number(&self, electrons: f64) -> u32 {
        let dn = self.rounded(self.black_level_dn + self.gain_dn_e * electrons);
        if self.digital_gain == 1.0 {
            return dn as u32;
        }
        self.rounded(self.black_level_dn + self.digital_gain * (dn - self.black_level_dn)) as u32
    }

    fn rounded(&self, dn: f64) -> f64 {
        dn.round_ties_even().clamp(0.0, self.largest_dn)
    }

    /// The electrons that a digital number stands for.
    pub(crate) fn electrons(&self, dn: f64) -> f64 {
        (dn - self.black_level_dn) / (self.digital_gain * self.gain_dn_e)
    }

    /// The digital number of a voltage without rounding, up to the largest.
    pub(crate) fn level_dn(&self, electrons: f64) -> f64 {
        let before = (self.black_level_dn + self.gain_dn_e * electrons).min(self.largest_dn);
        (self.black_level_dn + self.digital_gain * (before - self.black_level_dn)).min(self.largest_dn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::tests::ideal;

    #[test]
    fn rounds_to_even_and_clips_after_the_offset() {
        let mut p = ideal();
        (p.read_out.bits, p.read_out.black_level_dn, p.read_out.gain_dn_e) = (8, 10.0, 0.5);
        let with = |p: &SensorParameters| Converter::of(p, &Operation::described(p));
        let dn = [-100.0, -20.0, -3.0, 0.0, 1.0, 3.0, 4.0, 490.0, 1e12].map(|e| with(&p).digital_number(e));
        assert_eq!(dn, [0, 0, 8, 10, 10, 12, 12, 255, 255]);
        p.read_out.digital_gain = 2.0;
        let dn = [-3.0, 0.0, 4.0, 1e12].map(|e| with(&p).digital_number(e));
        assert_eq!(dn, [6, 10, 14, 255]);
        p.read_out.digital_gain = 1.0;
        p.read_out.bits = 24;
        assert_eq!(with(&p).digital_number(1e12), 16_777_215);
    }
}
