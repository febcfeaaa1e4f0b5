//! `[sensor]`: from the sensor plane to digital numbers.

use super::curve::{Curve, curve};
use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{Rule, RuleExt as _, choice, either, exactly, flag, keyed, known, number, record, vector, whole};
use etendue_spectra::camera;

record! {
    /// A sensor: its geometry, and its electronics where electrons are wanted.
    pub struct Sensor check(check) {
        /// Width of the picture, px, 1 … 65 536.
        required width_px: Placed<u64> = whole(1, 65_536);
        /// Height of the picture, px, 1 … 65 536.
        required height_px: Placed<u64> = whole(1, 65_536);
        /// Distance of the pixels' centres, µm, above 0; pixels are square.
        required pixel_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// Share of a pixel's area that is sensitive (a centred square), above 0 and at most 1. Default: 1.
        optional fill_factor: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Where the optical axis meets the picture, raster coordinates (the top-left corner is 0, 0), px.
        /// Default: the middle.
        optional principal_point_px: Placed<[f64; 2]> = vector::<2>(number("px"));
        /// The electronics.
        group electronics: Electronics;
    }
}

record! {
    /// What turns light to digital numbers.
    pub struct Electronics {
        /// Exposure time, s, above 0.
        required exposure_s: Placed<f64> = number("s").above(0.0);
        /// Colour filter array, named by its first two rows from the top-left pixel.
        required cfa: Placed<Cfa> = choice();
        /// Electrons per photon on the sensitive area, filter included, 0 … 1: a number, `{ spectrum = file }`, a list of
        /// three of these for red, green and blue, or `{ camera = name, peak = … }` for measured relative sensitivities.
        required quantum_efficiency: QuantumEfficiency = quantum_efficiency();
        /// Electrons that a pixel can hold, e⁻, above 0.
        required full_well_e: Placed<f64> = number("e⁻").above(0.0);
        /// Standard deviation of the read noise, e⁻, 0 or more.
        required read_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Dark current, e⁻/s, 0 or more.
        required dark_current_e_s: Placed<f64> = number("e⁻/s").at_least(0.0);
        /// Digital numbers per electron, DN/e⁻, above 0.
        required gain_dn_per_e: Placed<f64> = number("DN/e⁻").above(0.0);
        /// Digital number of no signal, DN, 0 or more and below the largest number of the converter.
        required black_level_dn: Placed<f64> = number("DN").at_least(0.0);
        /// Bits of the converter, 1 … 16.
        required bits: Placed<u64> = whole(1, 16);
        /// Whether shot noise and read noise are drawn. Default: true.
        optional noise: Placed<bool> = flag();
    }
}

choice! {
    /// A colour filter array.
    pub enum Cfa {
        /// No filters.
        "mono" => Mono,
        /// Red, green; green, blue.
        "rggb" => Rggb,
        /// Blue, green; green, red.
        "bggr" => Bggr,
        /// Green, red; blue, green.
        "grbg" => Grbg,
        /// Green, blue; red, green.
        "gbrg" => Gbrg,
    }
}

/// Electrons per photon on the sensitive area.
#[derive(Clone, Debug)]
pub enum QuantumEfficiency {
    /// The same in all pixels.
    Same(Curve),
    /// For red, green and blue.
    PerChannel(Placed<[Curve; 3]>),
    /// The measured relative sensitivities of a camera, scaled together so that the largest is `peak`.
    Measured {
        /// The camera's name.
        camera: Placed<String>,
        /// The largest quantum efficiency.
        peak: Placed<f64>,
    },
}

keyed! {
    /// Where quantum efficiencies are tabulated.
    pub enum QuantumEfficiencyTable {
        /// A table of two columns, wavelength in nm and quantum efficiency 0 … 1.
        spectrum => Spectrum(Placed<std::path::PathBuf>) = super::curve::spectrum_file();
        /// A camera whose relative sensitivities were measured, with "peak".
        camera => Camera(Placed<String>) = known("a measured camera", camera::names());
    }
}

record! {
    /// A quantum efficiency that needs a word.
    pub struct QuantumEfficiencySource check(check_source) {
        /// Where it is tabulated.
        inside table: QuantumEfficiencyTable;
        /// With "camera": the largest quantum efficiency of the three channels, above 0 and at most 1.
        optional peak: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

fn quantum_efficiency() -> impl Rule<Out = QuantumEfficiency> {
    let share = number("").at_least(0.0).at_most(1.0);
    let same = share.map(|v| QuantumEfficiency::Same(Curve::Constant(v)));
    let source = record::<QuantumEfficiencySource>().map(QuantumEfficiencySource::resolve);
    either(same, either(source, exactly(curve(share)).map(QuantumEfficiency::PerChannel)))
}

impl QuantumEfficiencySource {
    fn resolve(self) -> QuantumEfficiency {
        match (self.table, self.peak) {
            (QuantumEfficiencyTable::Spectrum(file), _) => QuantumEfficiency::Same(Curve::File(file)),
            (QuantumEfficiencyTable::Camera(camera), peak) => {
                let peak = peak.unwrap_or_else(|| Placed::new(1.0, camera.place.clone()));
                QuantumEfficiency::Measured { camera, peak }
            }
        }
    }
}

fn check_source(source: &QuantumEfficiencySource, faults: &mut Faults) {
    match (&source.table, &source.peak) {
        (QuantumEfficiencyTable::Spectrum(_), Some(peak)) => {
            faults.add(&peak.place, "\"peak\" has no effect here, it belongs to \"camera\"", "remove it");
        }
        (QuantumEfficiencyTable::Camera(camera), None) => faults.add(
            &camera.place,
            "measured sensitivities are relative and need \"peak\"",
            "add \"peak\": the largest quantum efficiency, above 0 and at most 1",
        ),
        _ => {}
    }
}

fn check(sensor: &Sensor, faults: &mut Faults) {
    let Some(electronics) = &sensor.electronics else { return };
    check_black_level(electronics, faults);
    check_channels(electronics, faults);
}

fn check_black_level(electronics: &Electronics, faults: &mut Faults) {
    let (black, bits) = (&electronics.black_level_dn, electronics.bits.value);
    let largest = ((1_u32 << bits) - 1).into();
    if black.value >= largest {
        let problem = format!("found {}, and a converter of {bits} bits ends at {largest} DN", black.value);
        faults.add(&black.place, problem, format!("give a number below {largest}"));
    }
}

fn check_channels(electronics: &Electronics, faults: &mut Faults) {
    let place = match &electronics.quantum_efficiency {
        QuantumEfficiency::Same(_) => return,
        QuantumEfficiency::PerChannel(list) => &list.place,
        QuantumEfficiency::Measured { camera, .. } => &camera.place,
    };
    if electronics.cfa.value == Cfa::Mono {
        let remedy = "give one number or one spectrum, or a \"cfa\" with colours";
        faults.add(place, "a quantum efficiency of three channels contradicts cfa = \"mono\"", remedy);
    }
}
