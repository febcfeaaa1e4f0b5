//! Merging captures: the first that is not saturated, scaled.
//!
//! value = black + s_k (DN_k − black), k the first capture with DN_k − black ≤ switch · (white_k − black), or the last one;
//! s_k the product of what the capture lost in time, sensitivity and gain. The value is in numbers of the first capture.
//! Left out: blending around the switch, weights by noise.

use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;

/// Captures merged so far.
#[derive(Clone, Debug)]
pub(crate) struct Merged {
    black_level_dn: f64,
    values: Vec<f32>,
    /// Whether no capture so far was below its switch.
    pending: Vec<bool>,
}

impl Merged {
    pub(crate) fn new(pixels: usize, black_level_dn: f64) -> Self {
        Self { black_level_dn, values: vec![0.0; pixels], pending: vec![true; pixels] }
    }

    /// Takes the next capture; numbers up to `switch_dn` are good. Values have 24 bits, which f32 holds.
    pub(crate) fn take(&mut self, numbers: &Plane<DigitalNumber>, scale: f64, switch_dn: f64) {
        for ((value, pending), dn) in self.values.iter_mut().zip(&mut self.pending).zip(numbers.samples()) {
            if *pending {
                let dn = f64::from(*dn);
                *value = (self.black_level_dn + scale * (dn - self.black_level_dn)) as f32;
                *pending = dn > switch_dn;
            }
        }
    }

    /// The merged numbers before rounding.
    pub(crate) fn values(&self) -> &[f32] {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use crate::frame::tests::{ADDRESS, quiet, run};
    use crate::hdr::Capture;
    use crate::parameters::SensorParameters;
    use etendue_core::Plane;
    use etendue_stats::Moments;

    const SAME: Capture = Capture {
        exposure_share: 1.0,
        sensitivity_share: 1.0,
        gain_share: 1.0,
        full_well_e: None,
        read_noise_e: None,
        same_charge: false,
    };

    /// 12 bits; a well of 4000 e⁻ at one DN an electron.
    fn three_exposures() -> SensorParameters {
        let mut p = quiet();
        (p.charge.full_well_e, p.read_out.bits, p.read_out.black_level_dn) = (3900.0, 12, 100.0);
        p.hdr.captures =
            vec![Capture { exposure_share: 1.0 / 16.0, ..SAME }, Capture { exposure_share: 1.0 / 256.0, ..SAME }];
        p.hdr.bits = Some(20);
        p
    }

    #[test]
    fn the_merged_number_is_linear_over_all_captures() {
        let means = [0.0, 100.0, 3000.0, 20_000.0, 50_000.0, 400_000.0, 900_000.0];
        let raw = run(&three_exposures(), &Plane::from_samples(7, 1, means.to_vec()).expect("filled"), ADDRESS);
        for (mean, dn) in means.iter().zip(raw.plane.samples()) {
            // A capture rounds to one of its own numbers.
            let step = if *mean <= 3500.0 {
                1.0
            } else if *mean <= 56_000.0 {
                16.0
            } else {
                256.0
            };
            assert!((f64::from(*dn) - 100.0 - f64::from(*mean)).abs() <= 0.5 * step, "{mean}: {dn}");
        }
        assert_eq!((raw.bits, raw.white_level_dn), (20, 100.0 + 256.0 * 3900.0));
        let saturated = run(&three_exposures(), &Plane::filled(1, 1, 1e9), ADDRESS);
        assert_eq!(f64::from(saturated.plane.at(0, 0)), saturated.white_level_dn);
    }

    #[test]
    fn captures_have_their_own_noise_and_snr_drops_at_the_switch() {
        let mut p = three_exposures();
        (p.noise, p.read_out.noise.white_e) = (true, 2.0);
        let snr = |mean: f32| {
            let raw = run(&p, &Plane::filled(256, 256, mean), ADDRESS);
            let m = Moments::of(raw.plane.samples().iter().map(|dn| f64::from(*dn) - 100.0));
            m.mean() / m.variance().expect("many").sqrt()
        };
        let (before, after) = (snr(3200.0), snr(4200.0));
        // μ/√(μ + σ² + 1/12) of the capture that is used; 65 536 pixels know it to 0.28 %, four of those.
        let of = |e: f64| e / (e + 4.0 + 1.0 / 12.0).sqrt();
        assert!((before / of(3200.0) - 1.0).abs() < 0.0112 && (after / of(4200.0 / 16.0) - 1.0).abs() < 0.0112);
    }

    #[test]
    fn dual_gain_reads_the_same_charge_twice() {
        let mut p = quiet();
        (p.noise, p.charge.full_well_e, p.read_out.bits) = (true, 60_000.0, 12);
        p.hdr.captures = vec![Capture { gain_share: 1.0 / 16.0, same_charge: true, ..SAME }];
        p.hdr.bits = Some(16);
        let means = Plane::filled(64, 64, 20_000.0);
        let merged = run(&p, &means, ADDRESS);
        // Without read noise the low gain sees the counts of the shot noise of the first capture, in steps of 16.
        let mut single = p.clone();
        single.hdr = super::super::HighDynamicRange::default();
        single.read_out.bits = 16;
        let counts = run(&single, &means, ADDRESS);
        assert!(merged.plane.samples().iter().zip(counts.plane.samples()).all(|(a, b)| a.abs_diff(*b) <= 8));
    }

    #[test]
    fn what_cannot_be_merged_is_refused() {
        let refused = |change: &dyn Fn(&mut SensorParameters)| {
            let mut p = three_exposures();
            change(&mut p);
            crate::Sensor::new(p).is_err()
        };
        assert!(!refused(&|_| ()));
        assert!(refused(&|p| p.hdr.bits = Some(16)));
        assert!(refused(&|p| p.hdr.bits = None));
        assert!(refused(&|p| p.hdr.captures.reverse()));
        assert!(refused(&|p| p.hdr.captures[0].same_charge = true));
    }
}
