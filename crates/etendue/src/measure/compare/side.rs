//! One side of a comparison: a measurement's JSON, or what a camera file declares of the same.

use super::curve::{Curve, curves};
use super::declared::{self, Light};
use crate::camera_file::open_camera;
use crate::camera_file::text_of;
use crate::error::Error;
use etendue_metrology::Estimate;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// A number with its unit; without an uncertainty where the measurement states none.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    pub value: f64,
    pub standard_uncertainty: Option<f64>,
    pub unit: String,
}

impl Quantity {
    /// What a camera file states: exact by itself.
    pub(crate) fn declared(value: f64, unit: &str) -> Self {
        Self { value, standard_uncertainty: Some(0.0), unit: unit.to_owned() }
    }
}

/// What is known of a camera on one side.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    pub kind: String,
    pub settings: BTreeMap<String, String>,
    pub quantities: BTreeMap<String, Quantity>,
    pub curves: Vec<Curve>,
    /// Angles of slanted edges to rows or columns, degrees, by their place.
    pub angles_deg: BTreeMap<String, f64>,
}

fn is_camera(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Both sides; a camera file declares what the other side measured.
pub(crate) fn sides(a: &Path, b: &Path, light: &Light, set: &[String]) -> Result<[Side; 2], Error> {
    let declaration = |file: &Path, measured: &Side| {
        let body = open_camera(file, set)?;
        let said = |reason: String| Error::input(format!("{}: {reason}", file.display()));
        declared::side(&body, measured, light).map_err(said)
    };
    match (is_camera(a), is_camera(b)) {
        (true, true) => Err(Error::input(
            "measure compare: two camera files: at least one side must be a measurement (the output of --json)",
        )),
        (true, false) => measurement(b).and_then(|b| Ok([declaration(a, &b)?, b])),
        (false, true) => measurement(a).and_then(|a| Ok([a.clone(), declaration(b, &a)?])),
        (false, false) => {
            if light.wavelength_nm.is_some() || light.illuminant.is_some() || !set.is_empty() {
                let told = "--wavelength-nm, --illuminant and --set belong to a camera file, and neither side is one";
                return Err(Error::input(told));
            }
            Ok([measurement(a)?, measurement(b)?])
        }
    }
}

fn measurement(file: &Path) -> Result<Side, Error> {
    let text = text_of(file)?;
    let what = "expected the JSON that etendue measure or calibrate prints with --json, or a camera file (.toml)";
    let no = |cause: &str| Error::input(format!("{}: {what}: {cause}", file.display()));
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

/// An estimate of a table's cell.
pub(crate) fn estimate(cell: &Value) -> Option<Estimate> {
    Some(Estimate::new(cell["value"].as_f64()?, cell["standard_uncertainty"].as_f64()?))
}
