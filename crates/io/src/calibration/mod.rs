//! Calibrated cameras of other programs.
//!
//! | format | file | models | centre of the top-left pixel |
//! | --- | --- | --- | --- |
//! | [`OpenCv`](CalibrationFormat::OpenCv) | FileStorage as YAML, XML or JSON | perspective with 14 coefficients, `cv::fisheye`, `cv::omnidir` | (0, 0) |
//! | [`Ros`](CalibrationFormat::Ros) | `camera_info` as YAML, INI or printed message | plumb_bob, rational_polynomial, thin_prism, equidistant | (0, 0) |
//! | [`Kalibr`](CalibrationFormat::Kalibr) | camchain YAML | pinhole, omni, eucm, ds with radtan, equidistant, fov, none | (0, 0) |
//! | [`Euroc`](CalibrationFormat::Euroc) | `sensor.yaml` | those of Kalibr | (0, 0) |
//! | [`Camodocal`](CalibrationFormat::Camodocal) | YAML | PINHOLE, PINHOLE_FULL, MEI, KANNALA_BRANDT, SCARAMUZZA | (0, 0) |
//! | [`Colmap`](CalibrationFormat::Colmap) | `cameras.txt`, `cameras.bin` | all | (0.5, 0.5) |
//! | [`Ocam`](CalibrationFormat::Ocam) | `calib_results.txt` | Scaramuzza's | (0, 0), row first |
//! | [`FTheta`](CalibrationFormat::FTheta) | NVIDIA's rig or NCore JSON | f-theta | (0, 0) |
//!
//! All become a [`Calibration`] in raster coordinates, in which that centre is at (0.5, 0.5). Other content of a file (dates, boards, extrinsics,
//! rectification) is ignored, and the [notes](ImportedCamera::notes) name it. A calibration that folds over inside its image is read; [`Calibration::check`]
//! refuses it.

mod camodocal;
mod colmap;
pub mod export;
mod f_theta;
mod file_storage;
mod kalibr;
mod likely_format;
mod models;
mod ocam;
mod opencv;
mod reader_result;
mod ros;
mod ros_ini;
mod xml;

use std::path::Path;

use etendue_core::words::Word as _;
use etendue_projection::Calibration;

use crate::hash::{self, ContentHash};
use crate::source::{decode_text, read_description_bytes};
use crate::tree::{TreeError, TreeResult, passed_over};
use crate::{Error, ErrorCode, tree as yaml};
use reader_result::{ReaderResult, camera_error};

pub use etendue_scene::asset::CalibrationFormat;

/// Camera of a calibration file.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedCamera {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// The camera.
    pub calibration: Calibration,
    /// False if the file states no image size: that of the calibration is arbitrary, and the caller's replaces it.
    pub states_size: bool,
    /// Ignored content, one sentence each.
    pub notes: Vec<String>,
    /// Content hash of the file.
    pub hash: ContentHash,
}

/// Reads one camera; `camera` selects it by name in a file with several.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_calibration(file: &Path, format: CalibrationFormat, camera: Option<&str>) -> Result<ImportedCamera, Error> {
    let bytes = read_description_bytes(file, "calibration")?;
    let result = if format == CalibrationFormat::Colmap && colmap::is_binary(&bytes) {
        colmap::read_binary(&bytes, camera)
    } else {
        let text = decode_text(file, &bytes)?;
        read_text(text, format, camera).map_err(|error| with_other_format(error, text, format))
    };
    let ReaderResult { name, calibration, states_size, notes } =
        result.and_then(|result| result.chosen(camera)).map_err(|error| error.in_file(file))?;
    Ok(ImportedCamera { name, calibration, states_size, notes, hash: hash::hash_bytes(&bytes) })
}

/// The error, with the format that the text appears to have.
fn with_other_format(error: TreeError, text: &str, stated: CalibrationFormat) -> TreeError {
    match likely_format::other_format(text, stated) {
        Some(other) => error.with_remedy(&format!("the file has the keys of the format \"{}\"", other.word())),
        None => error,
    }
}

fn read_text(text: &str, format: CalibrationFormat, camera: Option<&str>) -> TreeResult<ReaderResult> {
    match format {
        CalibrationFormat::OpenCv => opencv::read(text, false, camera),
        CalibrationFormat::OpenCvFisheye => opencv::read(text, true, camera),
        CalibrationFormat::Ros => ros::read(text, camera),
        CalibrationFormat::Kalibr => kalibr::read(text, camera),
        CalibrationFormat::Euroc => kalibr::read_euroc(text),
        CalibrationFormat::Camodocal => camodocal::read(text),
        CalibrationFormat::Colmap => colmap::read(text, camera),
        CalibrationFormat::Ocam => ocam::read(text),
        CalibrationFormat::FTheta => f_theta::read(text, camera),
    }
}
