//! A camera's EMVA 1288 data sheet, as printed: the input from which `etendue datasheet` makes a camera file.

use super::sensor::cfa::Cfa;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{Rule, choice, either, integer, keyed_by_name, list, number, record, text, variant, vector};

/// Points of a curve: wavelength, nm, and quantum efficiency, %.
pub type CurvePoints = Vec<Placed<[f64; 2]>>;

record! {
    /// A data sheet after EMVA 1288. Values that follow from others are checked and may be omitted.
    pub struct DataSheet check(check) {
        /// Name of the camera.
        required camera: Placed<String> = text("the camera's name");
        /// Image width.
        required width_px: Placed<u64> = integer(1, 65_536);
        /// Image height.
        required height_px: Placed<u64> = integer(1, 65_536);
        /// Pixel pitch.
        required pixel_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// Colour filter array. Default: "mono".
        optional cfa: Placed<Cfa> = choice();
        /// Total quantum efficiency, fill factor included: pairs of wavelength (nm) and efficiency (%), by channel for colour.
        required quantum_efficiency_percent: PrintedEfficiency = efficiency();
        /// Wavelength to which the keys in photons refer. Default: the only one of "quantum_efficiency_percent".
        optional measured_at_nm: Placed<f64> = number("nm").above(0.0);
        /// Bits of the ADC.
        required bits: Placed<u64> = integer(1, 24);
        /// System gain K.
        optional gain_dn_per_e: Placed<f64> = number("DN/e⁻").above(0.0);
        /// Inverse system gain 1/K.
        optional inverse_gain_e_per_dn: Placed<f64> = number("e⁻/DN").above(0.0);
        /// Temporal dark noise σ_d, without quantisation.
        optional temporal_dark_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Temporal dark noise σ_y.dark, with quantisation.
        optional temporal_dark_noise_dn: Placed<f64> = number("DN").above(0.0);
        /// Saturation capacity.
        required saturation_capacity_e: Placed<f64> = number("e⁻").above(0.0);
        /// Saturation capacity.
        optional saturation_capacity_p: Placed<f64> = number("photons").above(0.0);
        /// Maximum signal-to-noise ratio.
        optional snr_max: Placed<f64> = number("").above(0.0);
        /// The same ratio in bits.
        optional snr_max_db: Placed<f64> = number("dB").above(0.0);
        /// The same ratio in bits.
        optional snr_max_bit: Placed<f64> = number("bit").above(0.0);
        /// Dynamic range.
        optional dynamic_range: Placed<f64> = number("").above(0.0);
        /// The same ratio in bits.
        optional dynamic_range_db: Placed<f64> = number("dB").above(0.0);
        /// The same ratio in bits.
        optional dynamic_range_bit: Placed<f64> = number("bit").above(0.0);
        /// Absolute sensitivity threshold.
        optional sensitivity_threshold_e: Placed<f64> = number("e⁻").above(0.0);
        /// Absolute sensitivity threshold.
        optional sensitivity_threshold_p: Placed<f64> = number("photons").above(0.0);
        /// DSNU. Default: 0, with a warning.
        optional dsnu_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// PRNU. Default: 0, with a warning.
        optional prnu_percent: Placed<f64> = number("%").at_least(0.0).at_most(100.0);
        /// Dark current. Default: 0, with a warning.
        optional dark_current_e_s: Placed<f64> = number("e⁻/s").at_least(0.0);
        /// Temperature of the dark-current measurement.
        optional dark_current_at_c: Placed<f64> = number("°C").above(-273.15);
        /// Temperature difference that doubles the dark current.
        optional doubling_k: Placed<f64> = number("K").above(0.0);
        /// Linearity error; recorded, not modelled.
        optional linearity_error_percent: Placed<f64> = number("%").at_least(0.0);
        /// Digital number without signal. Default: keeps dark noise above zero.
        optional black_level_dn: Placed<f64> = number("DN").at_least(0.0);
    }
}

/// Quantum efficiencies as printed.
#[derive(Clone, Debug)]
pub enum PrintedEfficiency {
    /// The only channel.
    Mono(CurvePoints),
    /// By channel.
    Channels(Vec<(Placed<String>, CurvePoints)>),
}

impl PrintedEfficiency {
    /// The curves with the names of their channels.
    #[must_use]
    pub fn curves(&self) -> Vec<(&str, &CurvePoints)> {
        match self {
            Self::Mono(points) => vec![("mono", points)],
            Self::Channels(list) => list.iter().map(|(name, points)| (name.value.as_str(), points)).collect(),
        }
    }
}

fn points() -> impl Rule<Out = CurvePoints> {
    list(vector::<2>(number("").at_least(0.0)), 1)
}

fn efficiency() -> impl Rule<Out = PrintedEfficiency> {
    let channels = variant!(keyed_by_name(points()), PrintedEfficiency::Channels);
    either(variant!(points(), PrintedEfficiency::Mono), channels)
}

impl DataSheet {
    /// The filter array.
    #[must_use]
    pub fn filters(&self) -> Cfa {
        self.cfa.as_ref().map_or(Cfa::Mono, |cfa| cfa.value)
    }
}

fn check(sheet: &DataSheet, errors: &mut DescriptionErrors) {
    let either_of = |is_given: bool, names: &str, errors: &mut DescriptionErrors| {
        if !is_given {
            errors.add(ErrorCode::MissingKey, &sheet.place, format!("{names} are both missing"), "give one of them");
        }
    };
    let gain = sheet.gain_dn_per_e.is_some() || sheet.inverse_gain_e_per_dn.is_some();
    either_of(gain, "\"gain_dn_per_e\" and \"inverse_gain_e_per_dn\"", errors);
    let noise = sheet.temporal_dark_noise_e.is_some() || sheet.temporal_dark_noise_dn.is_some();
    either_of(noise, "\"temporal_dark_noise_e\" and \"temporal_dark_noise_dn\"", errors);
    let pairs = [
        (&sheet.dark_current_at_c, sheet.dark_current_e_s.is_some(), "dark_current_e_s"),
        (&sheet.doubling_k, sheet.dark_current_at_c.is_some(), "dark_current_at_c"),
    ];
    for (key, is_given, needed) in pairs {
        if let (Some(key), false) = (key, is_given) {
            errors.add(
                ErrorCode::NoEffect,
                &key.place,
                format!("this key has no effect without \"{needed}\""),
                "add it, or remove this key",
            );
        }
    }
    check_curves(sheet, errors);
}

fn check_curves(sheet: &DataSheet, errors: &mut DescriptionErrors) {
    for (_, points) in sheet.quantum_efficiency_percent.curves() {
        for point in points.iter().filter(|p| p.value[1] > 100.0) {
            errors.add(
                ErrorCode::OutOfRange,
                &point.place,
                format!("found an efficiency of {} %", point.value[1]),
                "give at most 100",
            );
        }
        for pair in points.windows(2).filter(|pair| pair[0].value[0] >= pair[1].value[0]) {
            let problem = format!("{} nm follows {} nm", pair[1].value[0], pair[0].value[0]);
            errors.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give the wavelengths in increasing order");
        }
    }
    let mut channels = sheet.filters().tile().to_vec();
    channels.sort_unstable();
    channels.dedup();
    let mut curves: Vec<&str> = sheet.quantum_efficiency_percent.curves().iter().map(|(name, _)| *name).collect();
    curves.sort_unstable();
    if channels != curves {
        let problem =
            format!("found quantum efficiencies of {} for the channels {}", curves.join(", "), channels.join(", "));
        errors.add(
            ErrorCode::WrongCount,
            &sheet.place,
            problem,
            "give one list for each channel of \"cfa\", in a table by channel for colours",
        );
    }
}
