//! Consistency of the figures of a data sheet.

use super::digits::PrintedRange;
use etendue_core::maths::f64::pow;
use etendue_scene::record::DataSheet;
use etendue_scene::{DescriptionError, ErrorCode, Placed};
use etendue_sensor::figures::{QUANTISATION_DN2, bit, db, threshold_e};

/// Errors and warnings of a data sheet.
#[derive(Debug, Default)]
pub(super) struct SheetFindings {
    pub(super) errors: Vec<DescriptionError>,
    pub(super) warnings: Vec<String>,
}

/// Unit of a figure.
#[derive(Clone, Copy)]
enum FigureUnit {
    Plain(&'static str),
    Decibel,
    Bit,
}

impl FigureUnit {
    fn unit(self) -> &'static str {
        match self {
            Self::Plain(unit) => unit,
            Self::Decibel => " dB",
            Self::Bit => " bit",
        }
    }

    /// Converts an amplitude ratio of at least 1 to this scale.
    fn ratio_to_scale(self, ratio: f64) -> f64 {
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

impl SheetFindings {
    /// Compares a stated figure with the value derived from others.
    fn compare(&mut self, figure: Option<&Placed<f64>>, scale: FigureUnit, follows: PrintedRange, from: &str) {
        let Some(figure) = figure else { return };
        if PrintedRange::printed(figure.value).meets(follows.rising(|x| scale.ratio_to_scale(x))) {
            return;
        }
        let off = scale.ratio(figure.value) / follows.printed - 1.0;
        let unit = scale.unit();
        let computed = four_digits(scale.ratio_to_scale(follows.printed));
        let problem = format!("found {}{unit}, but {computed}{unit} follows from {from}", figure.value);
        if off.abs() <= MAX_RELATIVE_DIFFERENCE {
            self.warnings.push(format!("{}: {problem}", figure.place));
        } else {
            self.errors.push(DescriptionError::new(
                ErrorCode::Contradiction,
                &figure.place,
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
pub(super) fn check(sheet: &DataSheet, gain_dn_e: f64) -> SheetFindings {
    let mut findings = SheetFindings::default();
    let gain = sheet.gain_dn_per_e.as_ref().map(|k| PrintedRange::printed(k.value));
    let inverse = sheet.inverse_gain_e_per_dn.as_ref().map(|k| PrintedRange::printed(k.value).falling(|x| 1.0 / x));
    let gain = gain.or(inverse).unwrap_or_else(|| PrintedRange::printed(gain_dn_e));
    let e = FigureUnit::Plain(" e⁻");
    let inverted = gain.falling(|x| 1.0 / x);
    findings.compare(sheet.inverse_gain_e_per_dn.as_ref(), FigureUnit::Plain(" e⁻/DN"), inverted, "\"gain_dn_per_e\"");
    let noise = dark_noise(sheet, gain, &mut findings);
    let capacity = PrintedRange::printed(sheet.saturation_capacity_e.value);
    let snr = capacity.rising(f64::sqrt);
    let from = "SNR_max² = saturation capacity";
    findings.compare(sheet.snr_max.as_ref(), FigureUnit::Plain(""), snr, from);
    findings.compare(sheet.snr_max_db.as_ref(), FigureUnit::Decibel, snr, from);
    findings.compare(sheet.snr_max_bit.as_ref(), FigureUnit::Bit, snr, from);
    let threshold = noise.with(inverted, |noise, inverted| threshold_e(noise, 1.0 / inverted));
    let from = "√(dark noise² + quantisation²) + ½";
    findings.compare(sheet.sensitivity_threshold_e.as_ref(), e, threshold, from);
    let range = capacity.over(threshold);
    let from = "saturation capacity / sensitivity threshold";
    findings.compare(sheet.dynamic_range.as_ref(), FigureUnit::Plain(""), range, from);
    findings.compare(sheet.dynamic_range_db.as_ref(), FigureUnit::Decibel, range, from);
    findings.compare(sheet.dynamic_range_bit.as_ref(), FigureUnit::Bit, range, from);
    photons(sheet, capacity, threshold, &mut findings);
    converter(sheet, gain.times(capacity), &mut findings);
    findings
}

/// σ_d, e⁻; if σ_y.dark is stated as well, both are compared in DN.
fn dark_noise(sheet: &DataSheet, gain: PrintedRange, findings: &mut SheetFindings) -> PrintedRange {
    if let Some(figure) = &sheet.temporal_dark_noise_e {
        let noise = PrintedRange::printed(figure.value);
        let dn = noise.times(gain).rising(|x| (x * x + QUANTISATION_DN2).sqrt());
        let from = "√((K · \"temporal_dark_noise_e\")² + 1/12)";
        findings.compare(sheet.temporal_dark_noise_dn.as_ref(), FigureUnit::Plain(" DN"), dn, from);
        return noise;
    }
    let dn = sheet.temporal_dark_noise_dn.as_ref().map(|dn| PrintedRange::printed(dn.value));
    let without = |x: f64| (x * x - QUANTISATION_DN2).max(0.0).sqrt();
    dn.map_or(PrintedRange::printed(0.0), |dn| dn.rising(without).over(gain))
}

/// Figures in photons, by the quantum efficiency at their wavelength.
fn photons(sheet: &DataSheet, capacity: PrintedRange, threshold: PrintedRange, findings: &mut SheetFindings) {
    let figures = [(&sheet.saturation_capacity_p, capacity), (&sheet.sensitivity_threshold_p, threshold)];
    let Some(first) = figures.iter().find_map(|(figure, _)| figure.as_ref()) else { return };
    let Some(efficiency) = efficiency(sheet) else {
        let problem = "figures in photons require the quantum efficiency at their wavelength; found several or none";
        let remedy = "add \"measured_at_nm\" within one curve of \"quantum_efficiency_percent\", or remove the figures \
                      in photons";
        findings.errors.push(DescriptionError::new(ErrorCode::MissingKey, &first.place, problem, remedy));
        return;
    };
    for (figure, electrons) in figures {
        let from = "electrons divided by the quantum efficiency";
        findings.compare(figure.as_ref(), FigureUnit::Plain(" photons"), electrons.over(efficiency), from);
    }
}

/// Quantum efficiency of the only channel at the wavelength of the measurement, as a fraction.
fn efficiency(sheet: &DataSheet) -> Option<PrintedRange> {
    let curves = sheet.quantum_efficiency_percent.curves();
    let [(_, points)] = curves.as_slice() else { return None };
    let fraction = |percent: f64| PrintedRange::printed(percent).rising(|x| 0.01 * x);
    match (&sheet.measured_at_nm, points.as_slice()) {
        (None, [only]) => Some(fraction(only.value[1])),
        (None, _) => None,
        (Some(nm), points) => points
            .windows(2)
            .find_map(|pair| between(pair[0].value, pair[1].value, nm.value, fraction))
            .or_else(|| points.iter().find(|p| p.value[0] == nm.value).map(|p| fraction(p.value[1]))),
    }
}

/// Interpolates linearly between two points.
fn between(a: [f64; 2], b: [f64; 2], nm: f64, fraction_at: impl Fn(f64) -> PrintedRange) -> Option<PrintedRange> {
    let t = (nm - a[0]) / (b[0] - a[0]);
    let (a, b) = (fraction_at(a[1]), fraction_at(b[1]));
    (0.0..=1.0).contains(&t).then(|| a.with(b, |a, b| a + t * (b - a)))
}

/// Checks that the saturation capacity has a digital number.
fn converter(sheet: &DataSheet, capacity_dn: PrintedRange, findings: &mut SheetFindings) {
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
    if middle <= (1.0 + MAX_RELATIVE_DIFFERENCE) * largest {
        findings.warnings.push(format!("{place}: {problem}"));
    } else {
        findings.errors.push(DescriptionError::new(
            ErrorCode::Contradiction,
            place,
            problem,
            "correct the capacity, the gain or the bits",
        ));
    }
}

/// Relative difference (of amplitudes) up to which contradicting figures of a data sheet only give a warning.
pub const MAX_RELATIVE_DIFFERENCE: f64 = 0.05;

/// Figures from which a camera is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SheetFigures {
    /// K, DN/e⁻.
    pub(super) gain_dn_e: f64,
    /// σ_d, e⁻, without quantisation.
    pub(super) dark_noise_e: f64,
    pub(super) black_level_dn: f64,
}

pub(super) fn largest_dn(sheet: &DataSheet) -> f64 {
    f64::from((1_u32 << sheet.bits.value) - 1)
}
