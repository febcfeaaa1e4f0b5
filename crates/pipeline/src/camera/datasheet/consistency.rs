//! Consistency of the figures of a data sheet.

use super::digits::Span;
use etendue_core::maths::f64::pow;
use etendue_scene::record::DataSheet;
use etendue_scene::{ErrorCode, Fault, Placed};
use etendue_sensor::figures::{QUANTISATION_DN2, bit, db, threshold_e};

/// Errors and warnings of a data sheet.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) faults: Vec<Fault>,
    pub(super) warnings: Vec<String>,
}

/// Unit of a figure.
#[derive(Clone, Copy)]
enum Scale {
    Plain(&'static str),
    Decibel,
    Bit,
}

impl Scale {
    fn unit(self) -> &'static str {
        match self {
            Self::Plain(unit) => unit,
            Self::Decibel => " dB",
            Self::Bit => " bit",
        }
    }

    /// Converts an amplitude ratio of at least 1 to this scale.
    fn of(self, ratio: f64) -> f64 {
        match self {
            Self::Plain(_) => ratio,
            Self::Decibel => db(ratio),
            Self::Bit => bit(ratio),
        }
    }

    /// Converts back to an amplitude ratio.
    fn ratio(self, value: f64) -> f64 {
        match self {
            Self::Plain(_) => value,
            Self::Decibel => pow(10.0, value / 20.0),
            Self::Bit => pow(2.0, value),
        }
    }
}

impl Found {
    /// Compares a stated figure with the value derived from others.
    fn compare(&mut self, stated: Option<&Placed<f64>>, scale: Scale, follows: Span, from: &str) {
        let Some(stated) = stated else { return };
        if Span::printed(stated.value).meets(follows.rising(|x| scale.of(x))) {
            return;
        }
        let off = scale.ratio(stated.value) / follows.printed - 1.0;
        let unit = scale.unit();
        let computed = four_digits(scale.of(follows.printed));
        let problem = format!("found {}{unit}, but {computed}{unit} follows from {from}", stated.value);
        if off.abs() <= LOOSE {
            self.warnings.push(format!("{}: {problem}", stated.place));
        } else {
            self.faults.push(Fault::new(
                ErrorCode::Contradiction,
                &stated.place,
                problem,
                "correct the figure that was misread",
            ));
        }
    }
}

/// A number with four digits, or with all digits before the decimal point.
fn four_digits(value: f64) -> String {
    let decimals = [1000.0, 100.0, 10.0].iter().filter(|bound| value < **bound).count();
    format!("{value:.decimals$}")
}

/// Compares all figures that can be derived from others.
pub(super) fn check(sheet: &DataSheet, gain_dn_e: f64) -> Found {
    let mut found = Found::default();
    let gain = sheet.gain_dn_per_e.as_ref().map(|k| Span::printed(k.value));
    let inverse = sheet.inverse_gain_e_per_dn.as_ref().map(|k| Span::printed(k.value).falling(|x| 1.0 / x));
    let gain = gain.or(inverse).unwrap_or_else(|| Span::printed(gain_dn_e));
    let e = Scale::Plain(" e⁻");
    let inverted = gain.falling(|x| 1.0 / x);
    found.compare(sheet.inverse_gain_e_per_dn.as_ref(), Scale::Plain(" e⁻/DN"), inverted, "\"gain_dn_per_e\"");
    let noise = dark_noise(sheet, gain, &mut found);
    let capacity = Span::printed(sheet.saturation_capacity_e.value);
    let snr = capacity.rising(f64::sqrt);
    let from = "SNR_max² = saturation capacity";
    found.compare(sheet.snr_max.as_ref(), Scale::Plain(""), snr, from);
    found.compare(sheet.snr_max_db.as_ref(), Scale::Decibel, snr, from);
    found.compare(sheet.snr_max_bit.as_ref(), Scale::Bit, snr, from);
    let threshold = noise.with(inverted, |noise, inverted| threshold_e(noise, 1.0 / inverted));
    let from = "√(dark noise² + quantisation²) + ½";
    found.compare(sheet.sensitivity_threshold_e.as_ref(), e, threshold, from);
    let range = capacity.over(threshold);
    let from = "saturation capacity / sensitivity threshold";
    found.compare(sheet.dynamic_range.as_ref(), Scale::Plain(""), range, from);
    found.compare(sheet.dynamic_range_db.as_ref(), Scale::Decibel, range, from);
    found.compare(sheet.dynamic_range_bit.as_ref(), Scale::Bit, range, from);
    photons(sheet, capacity, threshold, &mut found);
    converter(sheet, gain.times(capacity), &mut found);
    found
}

/// σ_d, e⁻; if σ_y.dark is stated as well, both are compared in DN.
fn dark_noise(sheet: &DataSheet, gain: Span, found: &mut Found) -> Span {
    if let Some(stated) = &sheet.temporal_dark_noise_e {
        let noise = Span::printed(stated.value);
        let dn = noise.times(gain).rising(|x| (x * x + QUANTISATION_DN2).sqrt());
        let from = "√((K · \"temporal_dark_noise_e\")² + 1/12)";
        found.compare(sheet.temporal_dark_noise_dn.as_ref(), Scale::Plain(" DN"), dn, from);
        return noise;
    }
    let dn = sheet.temporal_dark_noise_dn.as_ref().map(|dn| Span::printed(dn.value));
    let without = |x: f64| (x * x - QUANTISATION_DN2).max(0.0).sqrt();
    dn.map_or(Span::printed(0.0), |dn| dn.rising(without).over(gain))
}

/// Figures in photons, by the quantum efficiency at their wavelength.
fn photons(sheet: &DataSheet, capacity: Span, threshold: Span, found: &mut Found) {
    let figures = [(&sheet.saturation_capacity_p, capacity), (&sheet.sensitivity_threshold_p, threshold)];
    let Some(first) = figures.iter().find_map(|(stated, _)| stated.as_ref()) else { return };
    let Some(efficiency) = efficiency(sheet) else {
        let problem = "figures in photons require the quantum efficiency at their wavelength; found several or none";
        let remedy = "add \"measured_at_nm\" within one curve of \"quantum_efficiency_percent\", or remove the figures \
                      in photons";
        found.faults.push(Fault::new(ErrorCode::MissingKey, &first.place, problem, remedy));
        return;
    };
    for (stated, electrons) in figures {
        let from = "electrons divided by the quantum efficiency";
        found.compare(stated.as_ref(), Scale::Plain(" photons"), electrons.over(efficiency), from);
    }
}

/// Quantum efficiency of the only channel at the wavelength of the measurement, as a fraction.
fn efficiency(sheet: &DataSheet) -> Option<Span> {
    let curves = sheet.quantum_efficiency_percent.curves();
    let [(_, points)] = curves.as_slice() else { return None };
    let share = |percent: f64| Span::printed(percent).rising(|x| 0.01 * x);
    match (&sheet.measured_at_nm, points.as_slice()) {
        (None, [only]) => Some(share(only.value[1])),
        (None, _) => None,
        (Some(nm), points) => points
            .windows(2)
            .find_map(|pair| between(pair[0].value, pair[1].value, nm.value, share))
            .or_else(|| points.iter().find(|p| p.value[0] == nm.value).map(|p| share(p.value[1]))),
    }
}

/// Interpolates linearly between two points.
fn between(a: [f64; 2], b: [f64; 2], nm: f64, share: impl Fn(f64) -> Span) -> Option<Span> {
    let t = (nm - a[0]) / (b[0] - a[0]);
    let (a, b) = (share(a[1]), share(b[1]));
    (0.0..=1.0).contains(&t).then(|| a.with(b, |a, b| a + t * (b - a)))
}

/// Checks that the saturation capacity has a digital number.
fn converter(sheet: &DataSheet, capacity_dn: Span, found: &mut Found) {
    let black = sheet.black_level_dn.as_ref().map_or(0.0, |black| black.value);
    let (largest, bits) = (largest_dn(sheet), sheet.bits.value);
    if black + capacity_dn.low <= largest {
        return;
    }
    let place = &sheet.saturation_capacity_e.place;
    let middle = black + capacity_dn.printed;
    let problem = format!(
        "{} e⁻ correspond to {middle:.1} DN, but the largest number of {bits} bits is {largest} DN",
        sheet.saturation_capacity_e.value
    );
    if middle <= (1.0 + LOOSE) * largest {
        found.warnings.push(format!("{place}: {problem}"));
    } else {
        found.faults.push(Fault::new(
            ErrorCode::Contradiction,
            place,
            problem,
            "correct the capacity, the gain or the bits",
        ));
    }
}

/// Relative difference (of amplitudes) up to which contradicting figures of a data sheet only give a warning.
pub const LOOSE: f64 = 0.05;

/// Figures from which a camera is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Figures {
    /// K, DN/e⁻.
    pub(super) gain_dn_e: f64,
    /// σ_d, e⁻, without quantisation.
    pub(super) dark_noise_e: f64,
    /// Black level, DN.
    pub(super) black_level_dn: f64,
}

pub(super) fn largest_dn(sheet: &DataSheet) -> f64 {
    f64::from((1_u32 << sheet.bits.value) - 1)
}
