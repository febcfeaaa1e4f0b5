//! A measurement's JSON, read back.

use super::curve::curves;
use super::side::{Quantity, Side};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::text_of;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// What a measurement's JSON says of a camera.
pub(crate) fn measurement(file: &Path) -> Result<Side, Error> {
    let text = text_of(file)?;
    let what = "expected the JSON that etendue measure or calibrate prints with `json`, or a camera file (.toml)";
    let no = |cause: &str| Error::coded(ErrorCode::MalformedFile, format!("{}: {what}: {cause}", file.display()));
    let report: Value = serde_json::from_str(&text).map_err(|cause| no(&cause.to_string()))?;
    let kind = report["measurement"].as_str().ok_or_else(|| no("\"measurement\" is missing"))?.to_owned();
    let figures = report["figures"].as_object().ok_or_else(|| no("\"figures\" is missing"))?;
    let quantities = figures.iter().filter_map(|(key, figure)| Some((key.clone(), quantity(figure)?))).collect();
    let settings = report["settings"].as_object().into_iter().flatten();
    let settings = settings.filter_map(|(key, value)| Some((key.clone(), value.as_str()?.to_owned()))).collect();
    Ok(Side {
        kind,
        settings,
        quantities,
        curves: curves(&report["tables"]),
        angles_deg: angles(&report["tables"]["edges"]),
    })
}

fn angles(edges: &Value) -> BTreeMap<String, f64> {
    let one = |row: &Value| Some((row["at_px"].as_str()?.to_owned(), row["angle_deg"].as_f64()?));
    edges.as_array().into_iter().flatten().filter_map(one).collect()
}

fn quantity(figure: &Value) -> Option<Quantity> {
    Some(Quantity {
        value: figure["value"].as_f64()?,
        standard_uncertainty: figure["standard_uncertainty"].as_f64(),
        unit: figure["unit"].as_str()?.to_owned(),
    })
}
