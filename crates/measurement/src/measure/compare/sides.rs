//! Both sides of a comparison: from a measurement's JSON, or from the values that a camera file declares.

use std::{collections::BTreeMap, path::Path};

use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::text_of;
use etendue_plan_report::open_camera;
use serde_json::Value;

use super::side::{ComparisonSide, Light, Quantity};
use super::{declared, mean::curves};

fn is_camera(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Both sides; a camera file declares the quantities that the other side measured.
pub(crate) fn sides(a: &Path, b: &Path, light: &Light, set: &[String]) -> Result<[ComparisonSide; 2], Error> {
    let declaration = |file: &Path, measured: &ComparisonSide| {
        let body = open_camera(file, set)?;
        let unsuitable =
            |reason: String| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {reason}", file.display()));
        declared::side(&body, measured, light).map_err(unsuitable)
    };
    match (is_camera(a), is_camera(b)) {
        (true, true) => Err(Error::coded(
            ErrorCode::NotComparable,
            "measure compare: both sides are camera files; at least one must be a measurement (the output of `json`)",
        )),
        (true, false) => measurement(b).and_then(|b| Ok([declaration(a, &b)?, b])),
        (false, true) => measurement(a).and_then(|a| Ok([a.clone(), declaration(b, &a)?])),
        (false, false) => {
            if light.wavelength_nm.is_some() || light.illuminant.is_some() || !set.is_empty() {
                let message =
                    "`wavelength_nm`, `illuminant` and `set` apply to camera files only, and neither side is one";
                return Err(Error::argument("wavelength_nm", message));
            }
            Ok([measurement(a)?, measurement(b)?])
        }
    }
}

/// Facts about a camera from a measurement's JSON.
pub(crate) fn measurement(file: &Path) -> Result<ComparisonSide, Error> {
    let text = text_of(file)?;
    let message = "expected the JSON that etendue measure or calibrate prints with `json`, or a camera file (.toml)";
    let no = |error: &str| Error::coded(ErrorCode::MalformedFile, format!("{}: {message}: {error}", file.display()));
    let report: Value = serde_json::from_str(&text).map_err(|error| no(&error.to_string()))?;
    let kind = report["measurement"].as_str().ok_or_else(|| no("\"measurement\" is missing"))?.to_owned();
    let figures = report["figures"].as_object().ok_or_else(|| no("\"figures\" is missing"))?;
    let quantities = figures.iter().filter_map(|(key, figure)| Some((key.clone(), quantity(figure)?))).collect();
    let settings = report["settings"].as_object().into_iter().flatten();
    let settings = settings.filter_map(|(key, value)| Some((key.clone(), value.as_str()?.to_owned()))).collect();
    Ok(ComparisonSide {
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
