//! A calibrated camera, as written by another program.

use etendue_projection::Calibration;

use crate::reader::words;

words! {
    /// Format of a calibration file.
    pub enum CalibrationFormat {
        /// OpenCV's FileStorage as YAML, XML or JSON: perspective, unless the file states a fisheye or contains ξ.
        "opencv" => OpenCv,
        /// OpenCV's FileStorage with the coefficients of its fisheye module.
        "opencv_fisheye" => OpenCvFisheye,
        /// ROS camera_info: YAML, INI or a printed message.
        "ros" => Ros,
        /// Kalibr's camera chain, YAML.
        "kalibr" => Kalibr,
        /// EuRoC's sensor.yaml.
        "euroc" => Euroc,
        /// camodocal's YAML, as in VINS.
        "camodocal" => Camodocal,
        /// COLMAP's cameras.txt or cameras.bin.
        "colmap" => Colmap,
        /// OCamCalib's calib_results.txt.
        "ocam" => Ocam,
        /// NVIDIA's f-theta camera, JSON: a rig file of DriveWorks or a camera model of NCore.
        "f_theta" => FTheta,
    }
}

/// Selection of a camera of a calibration file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CalibrationChoice {
    /// Format of the file.
    pub format: CalibrationFormat,
    /// Name of the camera in a file of several.
    pub camera: Option<String>,
}

/// A camera of a calibration file.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationAsset {
    /// The camera, in raster coordinates.
    pub calibration: Calibration,
    /// False if the file states no image size, so that the sensor's is used.
    pub states_size: bool,
    /// Ignored content, one sentence each.
    pub report: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
