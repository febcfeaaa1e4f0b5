//! Figures of a sensor that follow from its parameters: those of EMVA 1288, dynamic range, temporal noise.
//!
//! The figures of EMVA 1288 (release 4.0 Linear) that follow from others.
//!
//! | figure | equation |
//! | --- | --- |
//! | quantisation noise | σ_q² = 1/12 DN² |
//! | temporal dark noise, e⁻ | σ_d = √(σ_y.dark² − σ_q²)/K |
//! | absolute sensitivity threshold, e⁻ | μ_e.min = √(σ_d² + σ_q²/K²) + ½ |
//! | largest signal-to-noise ratio | SNR_max = √μ_e.sat |
//! | dynamic range | DR = μ_e.sat/μ_e.min |
//!
//! The dynamic range of one frame and its signal-to-noise ratio, as described.
//!
//! In photo-electrons of the first capture: the lower end is the signal at a signal-to-noise ratio of 1, μ = ½ (1 + √(1 + 4 σ²)), σ² = read noise² +
//! dark electrons + quantisation² (EMVA 1288, equation 26, solved without its approximation); the upper end is that of the white level. The range is
//! 20 log₁₀ (upper/lower) dB.
//!
//! Each capture is used up to its switch. There the signal-to-noise ratio falls from μ_k/√(μ_k + σ_k²), with μ_k the electrons of this capture, to
//! that of the next one. Fixed patterns are excluded.
//!
//! Temporal fluctuation of the digital number of a pixel under constant light: shot noise of light and dark current, read noise and quantisation (EMVA 1288,
//! equation 10), in the electrons of the described exposure. Excluded: fixed patterns, blinking pixels and the sensor's memory of earlier frames.

use etendue_core::maths::f64::{log2, log10};

use crate::reading::{CaptureReading, readings};
use crate::{capture::OperatingPoint, parameters::SensorParameters, sensor::Sensor};

/// Variance of rounding, DN².
pub const QUANTISATION_DN2: f64 = 1.0 / 12.0;

/// Minimum temporal variance of dark pixels from which their noise can be determined, DN²; below it, rounding dominates.
pub const MIN_DARK_DN2: f64 = 0.24;

/// Temporal dark noise, e⁻, from a measured deviation of digital numbers (rounding included) at a gain in DN/e⁻; `None` if rounding alone exceeds it.
#[must_use]
pub fn dark_noise_e(sigma_y_dark_dn: f64, gain_dn_e: f64) -> Option<f64> {
    let variance = sigma_y_dark_dn * sigma_y_dark_dn - QUANTISATION_DN2;
    (variance >= 0.0).then(|| variance.sqrt() / gain_dn_e)
}

/// Signal at which the signal-to-noise ratio is 1, e⁻, by the standard's approximation.
#[must_use]
pub fn threshold_e(dark_noise_e: f64, gain_dn_e: f64) -> f64 {
    (dark_noise_e * dark_noise_e + QUANTISATION_DN2 / (gain_dn_e * gain_dn_e)).sqrt() + 0.5
}

/// A ratio of amplitudes in decibels.
#[must_use]
pub fn db(ratio: f64) -> f64 {
    20.0 * log10(ratio)
}

/// A ratio of amplitudes in bits.
#[must_use]
pub fn bit(ratio: f64) -> f64 {
    log2(ratio)
}

/// The dynamic range of one frame, in photo-electrons of the first capture.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicRange {
    /// The signal at a signal-to-noise ratio of 1, e⁻.
    pub lower_e: f64,
    /// The signal that reaches the white level, e⁻.
    pub upper_e: f64,
    /// Switches to the next capture.
    pub switches: Vec<CaptureTransition>,
}

/// A switch from a capture to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureTransition {
    /// The signal at the switch, e⁻ of the first capture.
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
        db(self.upper_e / self.lower_e)
    }
}

impl Sensor {
    /// The dynamic range of one frame of the sensor as described.
    #[must_use]
    pub fn dynamic_range(&self) -> DynamicRange {
        let p = self.parameters();
        let captures = readings(p, p.described_point());
        let variance = captures[0].dark_variance_e2(0.0);
        let pairs = captures.windows(2).map(|pair| {
            let at_e = pair[0].signal_e(p.hdr.transition_level_or_default());
            CaptureTransition { at_e, before: pair[0].ratio(at_e), after: pair[1].ratio(at_e) }
        });
        DynamicRange {
            lower_e: 0.5 * (1.0 + (1.0 + 4.0 * variance).sqrt()),
            upper_e: captures[captures.len() - 1].signal_e(1.0),
            switches: pairs.collect(),
        }
    }
}

/// The noise of one frame by the mean signal of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct TemporalNoise {
    /// The captures of a frame, the most sensitive first.
    captures: Vec<CaptureNoise>,
    exposure_s: f64,
    counts: bool,
}

/// The noise properties of a capture.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CaptureNoise {
    /// Its fraction of the described exposure's light.
    light: f64,
    /// Wells that are read together.
    wells: f64,
    /// Variance without the signal's shot noise, e⁻² of the capture, at the signal 0.
    dark_e2: f64,
    /// Upper limit of the signal of a pixel for this capture, e⁻ of the described exposure: white, or the switch to the next one.
    up_to_e: f64,
}

impl Sensor {
    /// Returns the temporal noise of a frame at the exposure and gain of the description. Under exposure control it is that of the longest exposure and
    /// the largest gain, the lowest relative to the light, and signals have no upper limit.
    #[must_use]
    pub fn temporal_noise(&self) -> TemporalNoise {
        let p = self.parameters();
        let point = most_sensitive(p);
        let wells = p.wells_read();
        let controlled = p.exposure.control.is_some();
        let of = |(reading, fraction): (&CaptureReading<'_>, f64)| CaptureNoise {
            light: reading.light,
            wells,
            dark_e2: if p.noise { reading.dark_variance_e2(0.0) } else { reading.quantisation_e2() },
            up_to_e: if controlled { f64::INFINITY } else { reading.signal_e(fraction) / wells },
        };
        let readings = readings(p, point);
        let switches = std::iter::repeat_n(p.hdr.transition_level_or_default(), readings.len() - 1).chain([1.0]);
        let captures = readings.iter().zip(switches).map(of).collect();
        TemporalNoise { captures, exposure_s: p.exposure.exposure_s, counts: p.noise }
    }
}

fn most_sensitive(p: &SensorParameters) -> OperatingPoint {
    let described = p.described_point();
    p.exposure.control.map_or(described, |control| OperatingPoint {
        exposure_s: control.exposure_s[1],
        analogue_gain: control.analogue_gain[1],
    })
}

impl TemporalNoise {
    /// The noise of one capture of `exposure_s` with photon noise and a constant variance (e⁻²), white at `white_e` electrons.
    #[must_use]
    pub fn from_one_capture(exposure_s: f64, dark_e2: f64, white_e: f64) -> Self {
        Self {
            captures: vec![CaptureNoise { light: 1.0, wells: 1.0, dark_e2, up_to_e: white_e }],
            exposure_s,
            counts: true,
        }
    }

    /// The same for a sensor that never saturates.
    #[must_use]
    pub fn without_saturation(mut self) -> Self {
        self.captures.iter_mut().for_each(|capture| capture.up_to_e = f64::INFINITY);
        self
    }

    /// Variance of the signal of a pixel of `mean_e` electrons of the described exposure (negative values count as 0), e⁻² of that exposure: that of
    /// the capture used at this signal. For pixels that are read together it is divided among them.
    #[must_use]
    pub fn variance_e2(&self, mean_e: f64) -> f64 {
        let mean_e = mean_e.max(0.0);
        let capture = self.captures.iter().find(|capture| mean_e < capture.up_to_e).or(self.captures.last());
        capture.map_or(0.0, |c| {
            let shot_e2 = if self.counts { mean_e * c.light } else { 0.0 };
            (shot_e2 + c.dark_e2 / c.wells) / (c.light * c.light)
        })
    }

    /// The signal of a pixel, e⁻ of the described exposure, above which every capture is white.
    #[must_use]
    pub fn white_e(&self) -> f64 {
        self.captures.last().map_or(0.0, |capture| capture.up_to_e)
    }

    /// The described exposure, s.
    #[must_use]
    pub fn exposure_s(&self) -> f64 {
        self.exposure_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{hdr::Capture, parameters::tests::ideal};

    #[test]
    fn noise_goes_to_numbers_and_back() {
        let (sigma_e, gain) = (5.0, 0.25);
        let measured = (sigma_e * sigma_e * gain * gain + QUANTISATION_DN2).sqrt();
        let back = dark_noise_e(measured, gain).expect("more than rounding");
        assert!((back - sigma_e).abs() < 1e-14, "{back}");
        // √(25 + 16/12) + ½.
        assert!((threshold_e(5.0, 0.25) - 5.631_601_439_4).abs() < 1e-9);
        assert_eq!(dark_noise_e(0.28, 1.0), None);
    }

    #[test]
    fn decibels_and_bits() {
        assert!((db(100.0) - 40.0).abs() < 1e-12 && (bit(1024.0) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn one_capture_has_the_range_of_emva_1288() {
        // σ = 5 e⁻ and a quantisation of 16/12; white at 60 000 e⁻.
        let range = Sensor::new(ideal()).expect("legal").dynamic_range();
        let variance: f64 = 25.0 + 16.0 / 12.0;
        let approximate = variance.sqrt() + 0.5;
        // The standard's approximation misses by 1/(8 σ).
        assert!((range.lower_e - approximate).abs() < 0.03 && (range.upper_e - 60_000.0).abs() < 1e-6);
        assert!((range.db() - 80.5).abs() < 0.05 && range.switches.is_empty(), "{}", range.db());
    }

    #[test]
    fn binned_wells_bring_their_dark_electrons() {
        let mut p = ideal();
        (p.charge.dark.current_e_s, p.exposure.exposure_s) = (100.0, 1.0);
        (p.charge.full_well.capacity_e, p.read_out.gain_dn_e) = (10_000.0, 1.0);
        let of = crate::layout::BinningMode::Charge;
        p.read_out.layout.binning = Some(crate::layout::Binning { columns: 2, rows: 2, of });
        let range = Sensor::new(p).expect("legal").dynamic_range();
        let variance = 25.0 + 400.0 + 1.0 / 12.0;
        let minimum = 0.5 * (1.0 + f64::sqrt(1.0 + 4.0 * variance));
        assert!((range.upper_e - 39_600.0).abs() < 1e-6 && (range.lower_e - minimum).abs() < 1e-9, "{range:?}");
    }

    #[test]
    fn ratios_fall_at_a_switch_by_the_root_of_what_is_lost() {
        let mut p = ideal();
        (p.voltage.noise.white_e, p.read_out.gain_dn_e) = (1e-3, 1.0);
        p.hdr.captures = vec![Capture { exposure_ratio: 1.0 / 16.0, ..Capture::default() }];
        p.hdr.bits = Some(24);
        let range = Sensor::new(p).expect("legal").dynamic_range();
        let switch = range.switches[0];
        assert!((switch.at_e - 54_000.0).abs() < 1e-6 && (range.upper_e - 960_000.0).abs() < 1e-3);
        // Shot noise alone, except for 1/12: √54 000 and √(54 000/16).
        assert!((switch.before / 232.38 - 1.0).abs() < 1e-4 && (switch.after / 58.095 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn one_capture_has_shot_read_and_quantisation_noise() {
        // 5 e⁻ of read noise and a quantisation of 16/12; white at 60 000 e⁻.
        let noise = Sensor::new(ideal()).expect("legal").temporal_noise();
        for mean_e in [0.0, 1.0, 500.0, 59_000.0] {
            assert!((noise.variance_e2(mean_e) - (mean_e + 25.0 + 16.0 / 12.0)).abs() < 1e-9);
        }
        assert!((noise.white_e() - 60_000.0).abs() < 1e-6 && noise.variance_e2(-3.0) == noise.variance_e2(0.0));
    }

    #[test]
    fn a_short_capture_is_noisier_in_the_light_of_the_first() {
        let mut p = ideal();
        p.hdr.captures = vec![Capture { exposure_ratio: 1.0 / 16.0, ..Capture::default() }];
        p.hdr.bits = Some(24);
        let noise = Sensor::new(p).expect("legal").temporal_noise();
        let dark_e2 = 25.0 + 16.0 / 12.0;
        assert!((noise.variance_e2(50_000.0) - (50_000.0 + dark_e2)).abs() < 1e-6);
        let bright_e = 160_000.0;
        assert!((noise.variance_e2(bright_e) - (bright_e / 16.0 + dark_e2) * 256.0).abs() < 1e-3);
        assert!((noise.white_e() - 960_000.0).abs() < 1e-3);
    }

    #[test]
    fn without_noise_numbers_are_only_rounded() {
        let mut p = ideal();
        p.noise = false;
        let noise = Sensor::new(p).expect("legal").temporal_noise();
        assert!((noise.variance_e2(1000.0) - 16.0 / 12.0).abs() < 1e-9);
    }
}
