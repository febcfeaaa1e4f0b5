//! Calibrated cameras of other programs.

use super::seeds::{repository, stored};
use super::target::{SCANNED, Target, result_text};
use etendue_io::calibration::{CalibrationFormat, read_calibration};
use std::path::Path;

const WORDS: &[&str] = &[
    "&a [1, 2]",
    "*a",
    "<<: *a",
    "!!opencv-matrix",
    "data: [1, .inf, .nan]",
    "rows: 1000000",
    "cols: 1000000",
    "- - - -",
    "? a",
    "|",
    ">",
    "---",
    "...",
    "%YAML 1.2",
    "\"data\":[1]",
    "fisheye_model: 1",
    "xi: 1.2",
    "distortion_model: equidistant",
    "camera_model: omni",
    "model_type: MEI",
    "<opencv_storage>",
    "<_>",
    "[image]",
    "cam0:",
    "cam6:",
    "OPENCV",
    "FULL_OPENCV",
    "null",
    "~",
    "ftheta",
];

/// A format with its seeds.
const fn target(
    name: &'static str,
    file: &'static str,
    prepare: fn(&Path) -> Vec<Vec<u8>>,
    read: fn(&Path) -> String,
) -> Target {
    Target { name, file, prepare, read, words: WORDS, is_text: true, times: SCANNED, constant_bytes: 16 << 20 }
}

/// Reads the camera of every name that is tried.
fn read(file: &Path, format: CalibrationFormat, cameras: &[Option<&str>]) -> String {
    cameras.iter().map(|camera| result_text(read_calibration(file, format, *camera)) + "; ").collect()
}

pub(super) const OPENCV: Target = target(
    "opencv",
    "a.yaml",
    |_| {
        repository([
            "tests/oracles/figures/calibrations/opencv.yml",
            "tests/oracles/figures/calibrations/opencv.json",
            "tests/oracles/figures/calibrations/opencv_fisheye.yml",
            "tests/oracles/figures/calibrations/opencv_omnidir.yml",
            "tests/oracles/figures/field_calibrations/out_camera_data.xml",
            "tests/oracles/figures/field_calibrations/stereo.xml",
            "tests/oracles/figures/field_calibrations/intrinsics.yml",
            "tests/oracles/figures/field_calibrations/maps.json",
            "tests/oracles/figures/field_calibrations/orb_slam_pinhole.yaml",
        ])
    },
    |file| {
        read(file, CalibrationFormat::OpenCv, &[None, Some("left"), Some("front")])
            + &read(file, CalibrationFormat::OpenCvFisheye, &[None])
    },
);
pub(super) const ROS: Target = target(
    "ros",
    "a.yaml",
    |_| {
        repository([
            "crates/io/tests/calibrations/camera_info.yaml",
            "tests/oracles/figures/rig/calibration/ros/rear.yaml",
            "tests/oracles/figures/field_calibrations/ros1_echo_twice.txt",
            "tests/oracles/figures/field_calibrations/ros2_echo.yaml",
            "tests/oracles/figures/field_calibrations/ost.txt",
        ])
    },
    |file| read(file, CalibrationFormat::Ros, &[None]),
);
pub(super) const KALIBR: Target = target(
    "kalibr",
    "a.yaml",
    |_| repository(["crates/io/tests/calibrations/camchain.yaml"]),
    |file| read(file, CalibrationFormat::Kalibr, &["cam0", "cam1", "cam2", "cam3", "cam4", "cam5"].map(Some)),
);
pub(super) const EUROC: Target = target(
    "euroc",
    "sensor.yaml",
    |_| repository(["tests/oracles/figures/field_calibrations/euroc_radtan.yaml"]),
    |file| read(file, CalibrationFormat::Euroc, &[None]),
);
pub(super) const CAMODOCAL: Target = target(
    "camodocal",
    "a.yaml",
    |_| {
        repository([
            "tests/oracles/figures/field_calibrations/camodocal_pinhole_full.yaml",
            "tests/oracles/figures/field_calibrations/camodocal_mei.yaml",
            "tests/oracles/figures/field_calibrations/camodocal_kannala_brandt.yaml",
            "tests/oracles/figures/field_calibrations/camodocal_scaramuzza.yaml",
        ])
    },
    |file| read(file, CalibrationFormat::Camodocal, &[None]),
);
pub(super) const COLMAP: Target = target(
    "colmap",
    "cameras.txt",
    |_| repository(["tests/oracles/figures/calibrations/cameras.txt"]),
    |file| read(file, CalibrationFormat::Colmap, &["1", "4", "7", "9", "11", "12", "14", "17", "18"].map(Some)),
);
pub(super) const COLMAP_BINARY: Target = Target {
    is_text: false,
    ..target(
        "colmap-binary",
        "cameras.bin",
        |_| repository(["tests/oracles/figures/field_calibrations/cameras.bin"]),
        |file| read(file, CalibrationFormat::Colmap, &["1", "4", "12", "18"].map(Some)),
    )
};
pub(super) const OCAM: Target = target(
    "ocam",
    "calib_results.txt",
    |_| repository(["crates/io/tests/calibrations/calib_results.txt"]),
    |file| read(file, CalibrationFormat::Ocam, &[None]),
);
pub(super) const F_THETA: Target = target(
    "f-theta",
    "a.json",
    |_| stored("f-theta"),
    |file| read(file, CalibrationFormat::FTheta, &[None, Some("camera:front:wide:120fov")]),
);
