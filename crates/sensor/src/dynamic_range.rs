//! What range of light one frame holds, and how well, as the description says it.
//!
//! In photo-electrons of the first capture: the least is the signal whose ratio to its noise is 1,
//! μ = ½ (1 + √(1 + 4 σ²)), σ² = read noise² + dark electrons + quantisation² (EMVA 1288, equation 26, solved without its
//! approximation); the most is that of the white level. The range is 20 log₁₀ (most/least) dB.
//!
//! Captures are read up to their switch; there the signal-to-noise ratio falls from μ_k/√(μ_k + σ_k²), with μ_k the electrons
//! that this capture has of the light, to that of the next one. Fixed patterns are no part of it.

use crate::emva1288::db;
use crate::reading::readings;
use crate::sensor::Sensor;

/// The range of light of one frame, in photo-electrons of the first capture.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicRange {
    /// The signal whose ratio to its noise is 1, e⁻.
    pub least_e: f64,
    /// The signal that reaches the white level, e⁻.
    pub most_e: f64,
    /// Where the reading goes on to the next capture.
    pub switches: Vec<Switch>,
}

/// A switch from a capture to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// The signal there, e⁻ of the first capture.
    pub at_e: f64,
    /// Signal-to-noise ratio of the capture before.
    pub before: f64,
    /// Signal-to-noise ratio of the capture after.
    pub after: f64,
}

impl DynamicRange {
    /// The range, dB.
    #[must_use]
    pub fn db(&self) -> f64 {
        db(self.most_e / self.least_e)
    }
}

impl Sensor {
    /// The range of light that one frame of the sensor holds, as described.
    #[must_use]
    pub fn dynamic_range(&self) -> DynamicRange {
        let p = self.parameters();
        let captures = readings(p, p.described_point());
        let variance = captures[0].dark_variance_e2(0.0);
        let pairs = captures.windows(2).map(|pair| {
            let at_e = pair[0].signal_e(p.hdr.switch());
            Switch { at_e, before: pair[0].ratio(at_e), after: pair[1].ratio(at_e) }
        });
        DynamicRange {
            least_e: 0.5 * (1.0 + (1.0 + 4.0 * variance).sqrt()),
            most_e: captures[captures.len() - 1].signal_e(1.0),
            switches: pairs.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdr::Capture;
    use crate::parameters::tests::ideal;

    #[test]
    fn one_capture_has_the_range_of_emva_1288() {
        // σ = 5 e⁻ and a quantisation of 16/12; white at 60 000 e⁻.
        let range = Sensor::new(ideal()).expect("legal").dynamic_range();
        let variance: f64 = 25.0 + 16.0 / 12.0;
        let approximate = variance.sqrt() + 0.5;
        // The standard's approximation misses by 1/(8 σ).
        assert!((range.least_e - approximate).abs() < 0.03 && (range.most_e - 60_000.0).abs() < 1e-6);
        assert!((range.db() - 80.5).abs() < 0.05 && range.switches.is_empty(), "{}", range.db());
    }

    #[test]
    fn binned_wells_bring_their_dark_electrons() {
        let mut p = ideal();
        (p.charge.dark.current_e_s, p.exposure.exposure_s) = (100.0, 1.0);
        (p.charge.full_well.capacity_e, p.read_out.gain_dn_e) = (10_000.0, 1.0);
        let of = crate::layout::BinningOf::Charge;
        p.read_out.layout.binning = Some(crate::layout::Binning { columns: 2, rows: 2, of });
        let range = Sensor::new(p).expect("legal").dynamic_range();
        let variance = 25.0 + 400.0 + 1.0 / 12.0;
        let least = 0.5 * (1.0 + f64::sqrt(1.0 + 4.0 * variance));
        assert!((range.most_e - 39_600.0).abs() < 1e-6 && (range.least_e - least).abs() < 1e-9, "{range:?}");
    }

    #[test]
    fn ratios_fall_at_a_switch_by_the_root_of_what_is_lost() {
        let mut p = ideal();
        (p.voltage.noise.white_e, p.read_out.gain_dn_e) = (1e-3, 1.0);
        p.hdr.captures = vec![Capture { exposure_ratio: 1.0 / 16.0, ..Capture::default() }];
        p.hdr.bits = Some(24);
        let range = Sensor::new(p).expect("legal").dynamic_range();
        let switch = range.switches[0];
        assert!((switch.at_e - 54_000.0).abs() < 1e-6 && (range.most_e - 960_000.0).abs() < 1e-3);
        // Shot noise alone, but for 1/12: √54 000 and √(54 000/16).
        assert!((switch.before / 232.38 - 1.0).abs() < 1e-4 && (switch.after / 58.095 - 1.0).abs() < 1e-4);
    }
}
