//! Both sides of a comparison: of a measurement's file, or of what a camera file declares of the same.

use super::declared;
use super::light::Light;
use super::measurement::measurement;
use super::side::Side;
use etendue_io::failure::{Error, ErrorCode};
use etendue_plan_report::open_camera;
use std::path::Path;

fn is_camera(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Both sides; a camera file declares what the other side measured.
pub(crate) fn sides(a: &Path, b: &Path, light: &Light, set: &[String]) -> Result<[Side; 2], Error> {
    let declaration = |file: &Path, measured: &Side| {
        let body = open_camera(file, set)?;
        let said = |reason: String| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {reason}", file.display()));
        declared::side(&body, measured, light).map_err(said)
    };
    match (is_camera(a), is_camera(b)) {
        (true, true) => Err(Error::coded(
            ErrorCode::NotComparable,
            "measure compare: two camera files: at least one side must be a measurement (the output of `json`)",
        )),
        (true, false) => measurement(b).and_then(|b| Ok([declaration(a, &b)?, b])),
        (false, true) => measurement(a).and_then(|a| Ok([a.clone(), declaration(b, &a)?])),
        (false, false) => {
            if light.wavelength_nm.is_some() || light.illuminant.is_some() || !set.is_empty() {
                let told = "`wavelength_nm`, `illuminant` and `set` belong to a camera file, and neither side is one";
                return Err(Error::argument("wavelength_nm", told));
            }
            Ok([measurement(a)?, measurement(b)?])
        }
    }
}
