//! Merging of captures: the first unsaturated one, scaled.
//!
//! value = black + s_k (DN_k − black), k the first capture with DN_k − black ≤ switch · (white_k − black), or the last one; s_k is the inverse of the
//! capture's relative time, sensitivity and gain. The value is in numbers of the first capture. Left out: blending around the switch, noise
//! weighting.

use etendue_core::{Plane, quantity::DigitalNumber};

use crate::signal_breakdown::SignalBreakdown;

/// Captures merged so far.
#[derive(Clone, Debug)]
pub(crate) struct MergedCaptures {
    black_level_dn: f64,
    width: usize,
    values: Vec<f32>,
    /// True if no capture so far was below its switch.
    pending: Vec<bool>,
    /// Signal breakdown of the captures used, if recorded.
    signal_breakdown: Option<SignalBreakdown>,
}

impl MergedCaptures {
    /// No captures yet.
    pub(crate) fn new(black_level_dn: f64) -> Self {
        Self { black_level_dn, width: 0, values: Vec::new(), pending: Vec::new(), signal_breakdown: None }
    }

    /// Adds the next capture; numbers up to `switch_dn` are valid. Values have 24 bits, which f32 represents exactly. `signal_breakdown`: the
    /// breakdown of the capture, and the factor from its electrons to those of the first.
    pub(crate) fn take(
        &mut self,
        numbers: &Plane<DigitalNumber>,
        scale: f64,
        switch_dn: f64,
        signal_breakdown: Option<(&SignalBreakdown, f64)>,
    ) {
        let pixels = numbers.samples().len();
        self.width = numbers.width();
        self.values.resize(pixels, 0.0);
        self.pending.resize(pixels, true);
        if let Some((signal_breakdown, factor)) = signal_breakdown {
            self.signal_breakdown.get_or_insert_with(|| signal_breakdown.clone()).replace(
                &self.pending,
                signal_breakdown,
                factor,
            );
        }
        for ((value, pending), dn) in self.values.iter_mut().zip(&mut self.pending).zip(numbers.samples()) {
            if *pending {
                let dn = f64::from(*dn);
                *value = (self.black_level_dn + scale * (dn - self.black_level_dn)) as f32;
                *pending = dn > switch_dn;
            }
        }
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.width, self.values.len() / self.width.max(1))
    }

    /// The merged numbers before rounding.
    pub(crate) fn values(&self) -> &[f32] {
        &self.values
    }

    /// Signal breakdown of the merged numbers, if recorded.
    pub(crate) fn into_breakdown(self) -> Option<SignalBreakdown> {
        self.signal_breakdown
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use crate::effects::response::Response;
    use crate::frame::tests::{ADDRESS, quiet, run};
    use crate::hdr::Capture;
    use crate::parameters::SensorParameters;
    use etendue_core::Plane;
    use etendue_stats::Moments;

    /// 12 bits; a well of 4000 e⁻ at one DN per electron.
    fn three_exposures() -> SensorParameters {
        let mut p = quiet();
        (p.charge.full_well.capacity_e, p.read_out.bits, p.read_out.black_level_dn) = (3900.0, 12, 100.0);
        p.hdr.captures = vec![
            Capture { exposure_ratio: 1.0 / 16.0, ..Capture::default() },
            Capture { exposure_ratio: 1.0 / 256.0, ..Capture::default() },
        ];
        p.hdr.bits = Some(20);
        p
    }

    #[test]
    fn the_merged_number_is_linear_over_all_captures() {
        let means = [0.0, 100.0, 3000.0, 20_000.0, 50_000.0, 400_000.0, 900_000.0];
        let raw = run(&three_exposures(), &Plane::from_samples(7, 1, means.to_vec()).expect("filled"), ADDRESS);
        for (mean, dn) in means.iter().zip(raw.plane.samples()) {
            // A capture rounds to its own numbers.
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
        (p.noise, p.voltage.noise.white_e) = (true, 2.0);
        let snr = |mean: f32| {
            let raw = run(&p, &Plane::filled(256, 256, mean), ADDRESS);
            let m = Moments::from_values(raw.plane.samples().iter().map(|dn| f64::from(*dn) - 100.0));
            m.mean() / m.variance().expect("many").sqrt()
        };
        let (before, after) = (snr(3200.0), snr(4200.0));
        // μ/√(μ + σ² + 1/12) of the capture used; 65 536 pixels give it to 0.28 %; tolerance: four of those.
        let of = |e: f64| e / (e + 4.0 + 1.0 / 12.0).sqrt();
        assert!((before / of(3200.0) - 1.0).abs() < 0.0112 && (after / of(4200.0 / 16.0) - 1.0).abs() < 0.0112);
    }

    #[test]
    fn causes_are_those_of_the_capture_that_is_used() {
        use crate::{Sensor, SensorState, SignalComponent};
        let mut p = three_exposures();
        (p.noise, p.voltage.noise.white_e, p.charge.dark.current_e_s) = (true, 2.0, 1000.0);
        let again = Capture { gain_ratio: 1.0 / 4.0, dual_conversion_gain: true, ..Capture::default() };
        p.hdr.captures.insert(0, again);
        let sensor = Sensor::new(p).expect("legal");
        let means = Plane::from_samples(5, 1, vec![0.0, 3000.0, 3800.0, 40_000.0, 700_000.0]).expect("filled");
        let raw = sensor.step(SensorState::default(), &means, ADDRESS).1;
        let (_, same, signal_breakdown) = sensor.step_with_breakdown(SensorState::default(), &means, ADDRESS);
        assert_eq!(raw, same);
        for x in 0..5 {
            let of = |cause: SignalComponent| f64::from(signal_breakdown.layer(cause).at(x, 0));
            let sum: f64 = SignalComponent::ALL.into_iter().filter(|c| *c != SignalComponent::Saturated).map(of).sum();
            // Ten layers of f32, each up to the signal.
            assert!((sum - (f64::from(raw.plane.at(x, 0)) - 100.0)).abs() < 0.05 + 1e-6 * sum.abs(), "{x}: {sum}");
            assert!((of(SignalComponent::Signal) / f64::from(means.at(x, 0)).max(1e-9) - 1.0).abs() < 1e-6 || x == 0);
        }
        // Counts of a capture of 1/256 of the time are multiples of 256.
        let counted = (signal_breakdown.layer(SignalComponent::Signal).at(4, 0)
            + signal_breakdown.layer(SignalComponent::Shot).at(4, 0))
            / 256.0;
        assert!((counted - counted.round()).abs() < 1e-3 && counted > 2000.0, "{counted}");
    }

    #[test]
    fn every_capture_has_its_account_of_charge() {
        let mut p = three_exposures();
        p.charge.full_well.blooming = Some(crate::effects::full_well::Blooming::Around { overflow_fraction: 0.5 });
        p.hdr.captures.insert(0, Capture { gain_ratio: 0.5, dual_conversion_gain: true, ..Capture::default() });
        let raw = run(&p, &Plane::filled(9, 9, 100_000.0), ADDRESS);
        let places: Vec<usize> = raw.accounts.iter().map(|(k, _)| *k).collect();
        assert_eq!(places, [0, 2, 3]);
        let generated: Vec<f64> = raw.accounts.iter().map(|(_, a)| a.generated_e.round()).collect();
        assert_eq!(generated, [8_100_000.0, 506_250.0, 31_641.0]);
    }

    #[test]
    fn dual_gain_reads_the_same_charge_twice() {
        let mut p = quiet();
        (p.noise, p.charge.full_well.capacity_e, p.read_out.bits) = (true, 60_000.0, 12);
        p.hdr.captures = vec![Capture { gain_ratio: 1.0 / 16.0, dual_conversion_gain: true, ..Capture::default() }];
        p.hdr.bits = Some(16);
        let means = Plane::filled(64, 64, 20_000.0);
        let merged = run(&p, &means, ADDRESS);
        // Without read noise the low gain sees the shot-noise counts of the first capture, in steps of 16.
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
        assert!(refused(&|p| p.hdr.captures[0].dual_conversion_gain = true));
        assert!(refused(&|p| p.hdr.captures.insert(0, Capture::default())), "a capture that is never used");
        assert!(refused(&|p| p.read_out.response = Response::Logarithmic { from_e: 1000.0 }), "merging is linear");
        // Exposures of 1, 1/16 and 1/256 of a second follow each other on the single photodiode.
        let period = |s: f64| refused(&|p| p.exposure.frame_period_s = Some(s * p.exposure.exposure_s));
        assert!(period(1.06) && !period(1.07));
        // The third capture must continue where the second ends: 0.9 · 3900 · 16 e⁻, of which its well holds 1/256.
        assert!(!refused(&|p| p.hdr.captures[1].full_well_e = Some(220.0)));
        assert!(refused(&|p| p.hdr.captures[1].full_well_e = Some(219.0)));
    }
}
