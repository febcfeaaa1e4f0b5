//! Converts an EMVA 1288 data sheet to a camera file.
//!
//! A data sheet's figures follow from each other (`etendue_sensor::figures`), so that reading errors become visible: K·1/K = 1, SNR_max² = μ_e.sat, DR =
//! μ_e.sat/μ_e.min, μ_e.min from σ_d and K, photons times efficiency are electrons, and the saturation capacity has a digital number. Each pair is compared
//! with the tolerance of its digits: half a unit of the last one, of the figure and of all figures from which it is computed (trailing zeros do not count as
//! digits). Data sheets mix means of several units of a camera. A larger difference of up to [`MAX_RELATIVE_DIFFERENCE`] is therefore accepted with a warning; beyond it, the
//! sheet contradicts itself and is refused.

mod consistency;
mod digits;
mod write;

pub use consistency::MAX_RELATIVE_DIFFERENCE;
use consistency::{SheetFigures, largest_dn};

use etendue_scene::record::DataSheet;
use etendue_scene::{DescriptionError, ErrorCode};
use etendue_sensor::figures::{MIN_DARK_DN2, dark_noise_e};

/// A camera file made from a data sheet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataSheetCamera {
    /// The camera file, TOML.
    pub camera: String,
    /// The tables that it names: file name and text of each.
    pub tables: Vec<(String, String)>,
    /// Doubtful or omitted figures.
    pub warnings: Vec<String>,
}

/// Camera file of a data sheet; the names of its tables begin with `stem`.
///
/// # Errors
/// All contradictions, with their places.
pub fn imported(sheet: &DataSheet, stem: &str) -> Result<DataSheetCamera, Vec<DescriptionError>> {
    let gain_dn_e = gain(sheet);
    let noise = noise(sheet, gain_dn_e).map_err(|error| vec![error])?;
    let consistency::SheetFindings { errors, mut warnings } = consistency::check(sheet, gain_dn_e);
    if !errors.is_empty() {
        return Err(errors);
    }
    let figures = SheetFigures { gain_dn_e, dark_noise_e: noise, black_level_dn: black_level(sheet, gain_dn_e, noise) };
    warnings.extend(notes(sheet));
    let tables = write::tables(sheet, stem);
    Ok(DataSheetCamera { camera: write::camera(sheet, figures, stem), tables, warnings })
}

/// K; if its inverse is stated too, K itself is used.
fn gain(sheet: &DataSheet) -> f64 {
    let inverse = sheet.inverse_gain_e_per_dn.as_ref().map(|k| 1.0 / k.value);
    sheet.gain_dn_per_e.as_ref().map(|k| k.value).or(inverse).expect("a record that was read has one")
}

/// σ_d, e⁻, as stated or from σ_y.dark without its quantisation.
fn noise(sheet: &DataSheet, gain_dn_e: f64) -> Result<f64, DescriptionError> {
    if let Some(noise) = &sheet.temporal_dark_noise_e {
        return Ok(noise.value);
    }
    let dn = sheet.temporal_dark_noise_dn.as_ref().expect("a record that was read has one");
    dark_noise_e(dn.value, gain_dn_e).ok_or_else(|| {
        let problem = format!("a dark noise of {} DN is below the quantisation noise of 0.289 DN", dn.value);
        DescriptionError::new(
            ErrorCode::OutOfRange,
            &dn.place,
            problem,
            "give the figure in DN including quantisation, or \"temporal_dark_noise_e\"",
        )
    })
}

/// Black level as stated; otherwise five standard deviations of the dark noise, if the ADC can hold the saturation capacity above it.
fn black_level(sheet: &DataSheet, gain_dn_e: f64, noise_e: f64) -> f64 {
    if let Some(level) = &sheet.black_level_dn {
        return level.value;
    }
    let room = largest_dn(sheet) - gain_dn_e * sheet.saturation_capacity_e.value;
    (5.0 * gain_dn_e * noise_e + 1.0).ceil().min(room.floor()).max(0.0)
}

/// Figures that the sheet does not state, or that the camera omits.
fn notes(sheet: &DataSheet) -> Vec<String> {
    let mut plan_notes = Vec::new();
    let missing = [
        (sheet.dsnu_e.is_none(), "dsnu_e"),
        (sheet.prnu_percent.is_none(), "prnu_percent"),
        (sheet.dark_current_e_s.is_none(), "dark_current_e_s"),
    ];
    plan_notes
        .extend(missing.iter().filter(|m| m.0).map(|m| format!("{}: \"{}\" is missing; 0 is used", sheet.place, m.1)));
    let photons = sheet.saturation_capacity_p.is_some() || sheet.sensitivity_threshold_p.is_some();
    if let (Some(key), false) = (&sheet.measured_at_nm, photons) {
        plan_notes.push(format!(
            "{}: \"measured_at_nm\" is not used: \"saturation_capacity_p\" and \"sensitivity_threshold_p\" are missing",
            key.place
        ));
    }
    if let Some(error) = &sheet.linearity_error_percent {
        plan_notes.push(format!(
            "{}: a linearity error of {} % is not modelled: the response is linear",
            error.place, error.value
        ));
    }
    if let Some(dn) = sheet.temporal_dark_noise_dn.as_ref().filter(|dn| dn.value * dn.value <= MIN_DARK_DN2) {
        plan_notes.push(format!(
            "{}: {} DN is the minimum that the standard reports: the noise may be smaller",
            dn.place, dn.value
        ));
    }
    for (channel, points) in sheet.quantum_efficiency_percent.curves() {
        if let [only] = points.as_slice() {
            let message = format!("the efficiency of \"{channel}\" at {} nm is used at all wavelengths", only.value[0]);
            plan_notes.push(format!("{}: {message}", only.place));
        }
    }
    plan_notes
}
