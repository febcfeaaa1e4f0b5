//! The converter: electrons to digital numbers.
//!
//! DN = clip(round(black level + K e), 0, 2ᵇⁱᵗˢ − 1). Rounding is to the nearest, halves to even, without dither: dither
//! and rounding together would double the quantisation noise of 1/12 DN² (EMVA 1288). The black level is added before
//! rounding and clipping, so read noise below zero survives.
//! Left out: non-linearity, missing codes, several gains.

use super::Verdict;
use crate::sensor::SensorParameters;

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    (Verdict::Required, format!("{} DN/e⁻, black at {} DN, {} bits", p.gain_dn_e, p.black_level_dn, p.bits))
}

/// The converter, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Converter {
    gain_dn_e: f64,
    black_level_dn: f64,
    largest_dn: f64,
}

impl Converter {
    pub(super) fn new(p: &SensorParameters) -> Self {
        let largest_dn = f64::from((1_u32 << p.bits) - 1);
        Self { gain_dn_e: p.gain_dn_e, black_level_dn: p.black_level_dn, largest_dn }
    }

    /// The digital number of a charge.
    pub(crate) fn digital_number(&self, electrons: f64) -> u32 {
        let dn = (self.black_level_dn + self.gain_dn_e * electrons).round_ties_even();
        dn.clamp(0.0, self.largest_dn) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::tests::ideal;

    #[test]
    fn rounds_to_even_and_clips_after_the_offset() {
        let mut p = ideal();
        (p.bits, p.black_level_dn, p.gain_dn_e) = (8, 10.0, 0.5);
        let converter = Converter::new(&p);
        let dn = [-100.0, -20.0, -3.0, 0.0, 1.0, 3.0, 4.0, 490.0, 1e12].map(|e| converter.digital_number(e));
        assert_eq!(dn, [0, 0, 8, 10, 10, 12, 12, 255, 255]);
    }
}
