//! Validity of a sensor: all of its parameters, individually and in combination.

use crate::check::{Checks, SensorError};
use crate::effect::{Effect, SensorFacts, Visitor};
use crate::{effects::response::Response, parameters::SensorParameters};

/// All contradictions, in the order of the parameters.
pub(crate) fn errors(p: &SensorParameters) -> Vec<SensorError> {
    let mut checks = Checks::default();
    check_exposure(p, &mut checks);
    p.show(&mut EffectChecks { facts: p.facts(), checks: &mut checks });
    check_channels(p, &mut checks);
    if checks.errors.is_empty() {
        check_hdr(p, &mut checks);
    }
    if checks.errors.is_empty() {
        check_range(p, &mut checks);
    }
    checks.errors
}

fn check_exposure(p: &SensorParameters, checks: &mut Checks) {
    checks.positive("pixel_pitch_um", p.pixel.pitch_um);
    checks.fraction_above_0("fill_factor", p.pixel.fill_factor);
    checks.not_negative("exposure_s", p.exposure.exposure_s);
    if let Some(period_s) = p.exposure.frame_period_s {
        checks.positive("frame_period_s", period_s);
        checks.agree("frame_period_s", period_s >= p.exposure.exposure_s, || {
            format!("{period_s} s is shorter than exposure_s, {} s: give a longer one", p.exposure.exposure_s)
        });
    }
}

/// Each effect's own checks.
struct EffectChecks<'a> {
    facts: SensorFacts,
    checks: &'a mut Checks,
}

impl Visitor for EffectChecks<'_> {
    fn visit<E: Effect>(&mut self, effect: &E) {
        effect.check(&self.facts, self.checks);
    }
}

fn check_channels(p: &SensorParameters, checks: &mut Checks) {
    for (i, channel) in p.channels.iter().enumerate() {
        let (low, high) = (channel.quantum_efficiency.min_value(), channel.quantum_efficiency.max_value());
        if !(low >= 0.0 && high <= 1.0) {
            checks.errors.push(SensorError::Efficiency { channel: channel.name.clone(), low, high });
        }
        if !p.cfa.channels().contains(&i) {
            checks.errors.push(SensorError::UnusedChannel(channel.name.clone()));
        }
    }
    let largest = p.cfa.channels().iter().copied().max().unwrap_or(0);
    if largest >= p.channels.len() {
        checks.errors.push(SensorError::NoSuchChannel { channel: largest, channels: p.channels.len() });
    }
}

fn check_hdr(p: &SensorParameters, checks: &mut Checks) {
    p.hdr.check_each(checks);
    check_captures(p, checks);
    if checks.errors.is_empty() {
        check_bits(p, checks);
    }
    if let Some(companding) = &p.hdr.companding {
        companding.check_curve(p.hdr.bits.unwrap_or(p.read_out.bits), checks);
    }
}

/// Checks that captures can be taken and merged together.
fn check_captures(p: &SensorParameters, checks: &mut Checks) {
    let hdr = &p.hdr;
    let linear = p.read_out.response == Response::Linear;
    checks.agree("hdr.captures", linear || hdr.captures.is_empty(), || {
        "captures are merged as proportional to the light, but \"response\" is not linear: remove one of the two"
            .to_owned()
    });
    let operations = hdr.operations(p.described_operation());
    for (k, pair) in operations.windows(2).enumerate() {
        let same = hdr.scale(k + 1) == hdr.scale(k) && pair[1].full_well_e == pair[0].full_well_e;
        checks.agree("hdr.captures", !same, || {
            format!("entry {k} (from 0) reaches no further than the capture before it and is never used: remove it")
        });
    }
    if let Some(period_s) = p.exposure.frame_period_s {
        let sum_s = max_exposure_s(p);
        checks.agree("hdr.captures", sum_s <= period_s, || {
            format!("the exposures of a photodiode follow each other and take {sum_s} s in total, more than frame_period_s, {period_s} s: shorten them, or give a longer frame period")
        });
    }
}

/// The total time of the consecutive exposures of one photodiode, s, the largest of all photodiodes; captures of equal sensitivity share a
/// photodiode.
fn max_exposure_s(p: &SensorParameters) -> f64 {
    let exposed =
        p.hdr.captures.iter().filter(|c| !c.dual_conversion_gain).map(|c| (c.sensitivity_ratio, c.exposure_ratio));
    let all: Vec<(f64, f64)> = core::iter::once((1.0, 1.0)).chain(exposed).collect();
    let sum = |sensitivity: f64| all.iter().filter(|(s, _)| *s == sensitivity).map(|(_, ratio)| ratio).sum::<f64>();
    p.exposure.exposure_s * all.iter().map(|(sensitivity, _)| sum(*sensitivity)).fold(0.0, f64::max)
}

fn check_bits(p: &SensorParameters, checks: &mut Checks) {
    let hdr = &p.hdr;
    let Some(bits) = hdr.bits else {
        checks.agree("hdr.merged_bits", hdr.captures.is_empty(), || {
            "several captures need \"merged_bits\": give it".to_owned()
        });
        return;
    };
    checks
        .agree("hdr.merged_bits", !hdr.captures.is_empty(), || "there are no captures to merge: remove it".to_owned());
    let legal = (p.read_out.bits..=24).contains(&bits);
    checks.legal("hdr.merged_bits", f64::from(bits), legal, "a whole number from the ADC's bits to 24");
    let more_sensitive = (1..=hdr.captures.len()).find(|k| hdr.scale(*k) < hdr.scale(*k - 1));
    checks.agree("hdr.captures", more_sensitive.is_none(), || {
        let number = more_sensitive.unwrap_or(1) - 1;
        format!("entry {number} (from 0) is more sensitive than the one before it: list them by decreasing sensitivity")
    });
    check_ranges(p, checks);
    if checks.errors.is_empty() {
        let white = p.merged_white_dn(p.described_point());
        checks.agree("hdr.merged_bits", white < f64::from(1_u32 << bits), || {
            format!(
                "the merged range reaches {white:.0} DN, and {bits} bits end at {}: give more bits or fewer captures",
                (1_u32 << bits) - 1
            )
        });
    }
}

/// Each capture must extend beyond the range used of the previous one. At a larger gain, where the ADC saturates before the well, this holds all the
/// more.
fn check_ranges(p: &SensorParameters, checks: &mut Checks) {
    let operations = p.hdr.operations(p.operation(p.min_operating_point()));
    let ranges: Vec<f64> = (0..).zip(&operations).map(|(k, operation)| p.merged_range_dn(k, operation)).collect();
    for (k, pair) in ranges.windows(2).enumerate() {
        let used = p.hdr.transition_level_or_default() * pair[0];
        checks.agree("hdr.captures", pair[1] > used, || {
            format!(
                "entry {k} (from 0) is saturated {:.0} merged DN above black, and the one before it is used up to {used:.0}: give it a larger \
                 \"full_well_e\" or a smaller ratio of exposure, sensitivity or gain",
                pair[1]
            )
        });
    }
}

/// Checks that the range of light spans at least one digital number.
fn check_range(p: &SensorParameters, checks: &mut Checks) {
    let white = p.merged_white_dn(p.min_operating_point());
    checks.agree("gain_dn_per_e", white > p.read_out.black_level_dn, || {
        format!(
            "the gain is so small that a full pixel has the digital number of a dark one, {white} DN: give a larger one"
        )
    });
}

#[cfg(test)]
mod tests {
    use super::errors;
    use crate::Channel;
    use crate::cfa::Cfa;
    use crate::parameters::tests::ideal;
    use etendue_spectra::Spectrum;

    #[test]
    fn every_contradiction_is_reported() {
        let mut p = ideal();
        p.exposure.exposure_s = -1.0;
        p.voltage.noise.white_e = f64::NAN;
        p.read_out.bits = 33;
        p.channels[0].quantum_efficiency = Spectrum::constant(1.5);
        p.channels.push(Channel { name: "r".into(), quantum_efficiency: Spectrum::constant(0.5) });
        let errors_found = errors(&p);
        assert_eq!(errors_found.len(), 5, "{errors_found:?}");
        assert_eq!(errors_found[0].to_string(), "exposure_s is -1, but a finite number of at least 0 is needed");
        let mut p = ideal();
        p.read_out.gain_dn_e = 1e-30;
        assert!(errors(&p)[0].to_string().starts_with("gain_dn_per_e: the gain is so small"), "{:?}", errors(&p));
        let mut p = ideal();
        p.cfa = Cfa::tile(2, 1, vec![0, 3]).expect("a rectangle");
        assert_eq!(errors(&p).len(), 1);
    }
}
