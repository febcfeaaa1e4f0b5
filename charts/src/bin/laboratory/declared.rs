//! What a camera file declares of what is found.

use etendue::measure::{CompareRequest, compare};
use etendue::{Error, ExistingFiles, open_camera, write_file};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

const WAVELENGTH_NM: f64 = 550.0;
/// What a measurement finds, the parameter that it is of, and the factor between them.
const DECLARED: [(&str, &str, &str, f64); 17] = [
    ("ptc", "gain_dn_per_e", "sensor.gain_dn_per_e", 1.0),
    ("ptc", "dark_noise_e", "sensor.read_noise_e", 1.0),
    ("ptc", "dark_current_mean_e_per_s", "sensor.dark_current_e_s", 1.0),
    ("vignetting", "corner_percent", "lens.relative_illumination.corner_percent", 1.0),
    ("ptc", "dsnu_e_pixel", "sensor.non_uniformity.dsnu_e", 1.0),
    ("ptc", "dsnu_e_row", "sensor.non_uniformity.dsnu_row_e", 1.0),
    ("ptc", "dsnu_e_column", "sensor.non_uniformity.dsnu_column_e", 1.0),
    ("ptc", "prnu_percent_pixel", "sensor.non_uniformity.prnu", 0.01),
    ("ptc", "prnu_percent_row", "sensor.non_uniformity.prnu_row", 0.01),
    ("ptc", "prnu_percent_column", "sensor.non_uniformity.prnu_column", 0.01),
    ("calibrate", "fx_mm", "lens.principal_distance_mm", 1.0),
    ("calibrate", "fx_px", "lens.projection.fx_px", 1.0),
    ("calibrate", "fy_px", "lens.projection.fy_px", 1.0),
    ("calibrate", "cx_px", "lens.projection.cx_px", 1.0),
    ("calibrate", "cy_px", "lens.projection.cy_px", 1.0),
    ("calibrate", "k1", "lens.projection.k1", 1.0),
    ("calibrate", "k2", "lens.projection.k2", 1.0),
];
/// Of the reference cameras' files themselves: thin lenses without diffraction.
const ABSENT: [&str; 2] = ["effects.psf.variance_horizontal_px2", "effects.psf.variance_vertical_px2"];

/// The truth by parameters, of a laboratory whose measurements are `measurements`.
pub(crate) fn declared(place: &Path, measurements: &Value) -> Result<BTreeMap<String, f64>, Error> {
    let mut declared = written(&place.join("declared.toml"))?;
    declared.extend(ABSENT.map(|key| (key.to_owned(), 0.0)));
    for kind in ["ptc", "calibrate", "vignetting"] {
        for (quantity, value) in quantities(place, kind, &measurements[kind])? {
            let known =
                DECLARED.iter().filter(|(measured_quantity, name, ..)| *measured_quantity == kind && quantity == *name);
            declared.extend(known.map(|(_, _, key, factor)| ((*key).to_owned(), factor * value)));
        }
    }
    for (channel, value) in efficiencies(place, &measurements["ptc"])? {
        declared.insert(format!("sensor.quantum_efficiency.{channel}"), value);
    }
    Ok(declared)
}

/// Numbers of the camera file that are parameters themselves.
fn written(file: &Path) -> Result<BTreeMap<String, f64>, Error> {
    let body = open_camera(file, &[])?;
    let sensor = body.sensor.ok_or_else(|| Error::run("the reference cameras have sensors"))?;
    let p = sensor.parameters();
    let mut parameters = vec![
        ("sensor.full_well_e", p.charge.full_well.capacity_e),
        ("sensor.black_level_dn", p.read_out.black_level_dn),
    ];
    if let Some(hot) = p.charge.dark.hot {
        parameters.extend([("sensor.dark.hot.fraction", hot.fraction), ("sensor.dark.hot.mean_e_s", hot.mean_e_s)]);
    }
    // Pixels that exchange nothing; else, in green, what is seen depends on the light of the neighbours' colours.
    if p.light.crosstalk.is_none() {
        parameters.extend(["sensor.crosstalk.horizontal", "sensor.crosstalk.vertical"].map(|key| (key, 0.0)));
    }
    Ok(parameters.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// What the camera file declares of a measurement, by the measurement's names.
fn quantities(place: &Path, kind: &str, measured: &Value) -> Result<Vec<(String, f64)>, Error> {
    let file = place.join(format!("{kind}.json"));
    write_file(&file, measured.to_string().as_bytes(), ExistingFiles::Replace)?;
    let wavelength_nm = (kind == "ptc").then_some(WAVELENGTH_NM);
    // Hot pixels are told by themselves, and are no part of the dark current.
    let set = if kind == "ptc" { vec!["sensor.dark.hot=null".to_owned()] } else { Vec::new() };
    let request = CompareRequest { wavelength_nm, set, ..CompareRequest::new(file, place.join("declared.toml")) };
    let compared = compare(&request)?.report.json();
    let rows = compared["tables"]["quantities"].as_array().cloned().unwrap_or_default();
    let entry = |row: &Value| Some((row["quantity"].as_str()?.to_owned(), row["b"]["value"].as_f64()?));
    Ok(rows.iter().filter_map(entry).collect())
}

/// Quantum efficiencies of the channels at the flats' wavelength: photon transfer measures one of them.
fn efficiencies(place: &Path, measured: &Value) -> Result<Vec<(&'static str, f64)>, Error> {
    let channels: &[&str] =
        if measured["settings"]["channel"].is_string() { &["red", "green", "blue"] } else { &["mono"] };
    let mut channel_efficiencies = Vec::new();
    for channel in channels {
        let mut channel_report = measured.clone();
        if *channel != "mono" {
            channel_report["settings"]["channel"] = (*channel).into();
        }
        let own = quantities(place, "ptc", &channel_report)?.into_iter().find(|(name, _)| name == "quantum_efficiency");
        channel_efficiencies.extend(own.map(|(_, value)| (*channel, value)));
    }
    Ok(channel_efficiencies)
}
