//! The base camera file that a new camera file extends, and the check that the two together are a valid camera.

use std::path::Path;

use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::read_text;
use etendue_scene::{Overrides, load_camera, record::Camera};

use super::camera::CharacterisationResults;

/// Reads the camera of a base file.
///
/// # Errors
/// If it cannot be read.
pub(super) fn open(file: &Path) -> Result<Camera, Error> {
    load_camera(file, &read_text, &Overrides::default()).map_err(|errors| Error::inputs(errors.as_slice()))
}

/// Refuses a base with a key whose effect is already contained in the measured values.
pub(super) fn refuse_what_is_measured(
    file: &Path,
    base: &Camera,
    results: &CharacterisationResults,
) -> Result<(), Error> {
    let sensor = &base.sensor;
    let mut duplicates = Vec::new();
    if let (Some(measured), Some(based)) = (&results.electronics, &sensor.electronics) {
        let dark = based.dark.as_ref().is_some_and(|dark| dark.temperature_c.is_some());
        let keys = [
            ("sensor.analogue_gain", based.analogue_gain.is_some(), "the gain"),
            ("sensor.row_noise_e", based.row_noise_e.is_some(), "the noise in the dark"),
            ("sensor.column_noise_e", based.column_noise_e.is_some(), "the noise in the dark"),
            ("sensor.rts_noise", based.rts_noise.is_some(), "the noise in the dark"),
            ("sensor.dark.temperature_c", dark && measured.dark_current_e_s.is_some(), "the dark current"),
            ("sensor.angle_response", based.angle_response.is_some() && results.fall_off.is_some(), "the fall-off"),
            (
                "sensor.fill_factor",
                sensor.fill_factor.is_some() && measured.efficiency.is_some(),
                "the quantum efficiency",
            ),
        ];
        duplicates.extend(keys.into_iter().filter(|(_, is_there, _)| *is_there));
    }
    let messages: Vec<String> = duplicates
        .into_iter()
        .map(|(key, _, quantity)| {
            format!(
                "{}: {key} would be applied to {quantity} that was measured, which already includes it; remove the key from a copy of the base",
                file.display()
            )
        })
        .collect();
    if messages.is_empty() { Ok(()) } else { Err(Error::all_coded(ErrorCode::Contradiction, messages)) }
}

/// Refuses numbers that do not form a valid camera.
///
/// # Errors
/// If the camera file would be refused.
pub(super) fn check(file: &Path, text: &str) -> Result<(), Error> {
    let read = |path: &Path| if path == file { Ok(text.to_owned()) } else { read_text(path) };
    load_camera(file, &read, &Overrides::default()).map(drop).map_err(|errors| {
        let messages =
            errors.as_slice().iter().map(|error| format!("the measured values do not form a valid camera: {error}"));
        Error::all_coded(ErrorCode::NotMeasurable, messages)
    })
}
