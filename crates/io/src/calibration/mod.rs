//! Calibrated cameras of other programs.
//!
//! | format | file | models | centre of the top-left pixel |
//! | --- | --- | --- | --- |
//! | [`OpenCv`](CalibrationFormat::OpenCv) | FileStorage as YAML or JSON | perspective with 14 coefficients, `cv::fisheye`, `cv::omnidir` | (0, 0) |
//! | [`Ros`](CalibrationFormat::Ros) | `camera_info` YAML | plumb_bob, rational_polynomial, equidistant | (0, 0) |
//! | [`Kalibr`](CalibrationFormat::Kalibr) | camchain YAML | pinhole, omni, eucm, ds with radtan, equi, fov, none | (0, 0) |
//! | [`Colmap`](CalibrationFormat::Colmap) | `cameras.txt` | all | (0.5, 0.5) |
//! | [`Ocam`](CalibrationFormat::Ocam) | `calib_results.txt` | Scaramuzza's | (0, 0), row first |
//! | [`FTheta`](CalibrationFormat::FTheta) | NVIDIA's rig or NCore JSON | f-theta | (0, 0) |
//!
//! All become a [`Calibration`] in raster coordinates, in which that centre is at (0.5, 0.5). Other content of a file (dates, boards, extrinsics,
//! rectification) is ignored, and the [notes](ImportedCamera::notes) name it. A calibration that folds over inside its image is read; [`Calibration::check`]
//! refuses it.

mod colmap;
pub mod export;
mod f_theta;
mod fields;
mod kalibr;
mod ocam;
mod opencv;

use std::path::Path;

use etendue_projection::Calibration;

use crate::hash::{self, ContentHash};
use crate::source::{decode_text, read_description_bytes};
use crate::tree::{TreeError, TreeResult, passed_over};
use crate::{Error, ErrorCode, tree as yaml};
use fields::{ReaderResult, camera_error};

pub use etendue_scene::asset::CalibrationFormat;

/// Camera of a calibration file.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedCamera {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// The camera.
    pub calibration: Calibration,
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
    let text = decode_text(file, &bytes)?;
    let read = match format {
        CalibrationFormat::OpenCv => opencv::read_opencv(text, false),
        CalibrationFormat::OpenCvFisheye => opencv::read_opencv(text, true),
        CalibrationFormat::Ros => opencv::read_ros(text),
        CalibrationFormat::Kalibr => kalibr::read(text, camera),
        CalibrationFormat::Colmap => colmap::read(text, camera),
        CalibrationFormat::Ocam => ocam::read(text),
        CalibrationFormat::FTheta => f_theta::read(text, camera),
    };
    let (name, calibration, notes) =
        read.and_then(|result| result.chosen(camera)).map_err(|error| error.in_file(file))?;
    Ok(ImportedCamera { name, calibration, notes, hash: hash::hash_bytes(&bytes) })
}
