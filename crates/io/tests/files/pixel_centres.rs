//! Centre of the top-left pixel in each format of calibration files, by the format's own definition: a file whose principal point lies there looks along the
//! axis at this project's (0.5, 0.5).

use etendue_io::calibration::{CalibrationFormat, read_calibration};
use glam::{DVec2, DVec3};

/// The raster point at which the camera of a file of this text sees its axis.
#[track_caller]
fn axis(format: CalibrationFormat, text: &str) -> DVec2 {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, text).expect("written");
    let camera = read_calibration(&file, format, None).unwrap_or_else(|error| panic!("{error}\n{text}")).calibration;
    assert_eq!(camera.size_px(), [640, 480]);
    // The centre of the top-left pixel is exactly on the axis: no number is rounded.
    let at = camera.project(DVec3::Z).expect("the axis is seen");
    let back = camera.unproject(at).expect("seen");
    assert!((back - DVec3::Z).length() < 1e-15, "{back}");
    at
}

const CENTRE: DVec2 = DVec2::new(0.5, 0.5);

/// `cv::initUndistortRectifyMap` fills its maps for whole numbers u, v of columns and rows: pixel (0, 0) has its centre there. Images also confirm it:
/// `charts.rs` in the binary's tests.
#[test]
fn opencv_counts_centres_from_zero() {
    let matrix = "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 500., 0., 0., 0., 500., 0., 0., 0., 1. ]\n";
    let size = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n";
    let k = |n: usize| {
        format!(
            "distortion_coefficients: !!opencv-matrix\n   rows: {n}\n   cols: 1\n   dt: d\n   data: [{}]\n",
            vec!["0.1"; n].join(", ")
        )
    };
    assert_eq!(axis(CalibrationFormat::OpenCv, &format!("{size}{matrix}{}", k(5))), CENTRE);
    assert_eq!(axis(CalibrationFormat::OpenCvFisheye, &format!("{size}{matrix}{}", k(4))), CENTRE);
    let json = r#"{"image_width": 640, "image_height": 480, "camera_matrix": [[500, 0, 0], [0, 500, 0], [0, 0, 1]],
                   "distortion_coefficients": [0.1, 0.01, 0, 0]}"#;
    assert_eq!(axis(CalibrationFormat::OpenCv, json), CENTRE);
}

/// sensor_msgs/CameraInfo hands its K to OpenCV as it is (image_geometry), so its whole numbers are OpenCV's.
#[test]
fn ros_counts_centres_from_zero() {
    let text = "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 0, 0, 500, 0, 0, 0, 1]\n\
                distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.1, 0, 0, 0, 0]\n";
    assert_eq!(axis(CalibrationFormat::Ros, text), CENTRE);
}

/// Kalibr fits its models to corners as `cv::cornerSubPix` gives them, whose whole numbers are centres.
#[test]
fn kalibr_counts_centres_from_zero() {
    for (camera, distortion, extra) in
        [("pinhole", "radtan", ""), ("pinhole", "equi", ""), ("ds", "none", "0.1, 0.5, ")]
    {
        let k = if distortion == "none" { "[]" } else { "[0.1, 0.01, 0, 0]" };
        let text = format!(
            "cam0:\n  camera_model: {camera}\n  distortion_model: {distortion}\n  distortion_coeffs: {k}\n  \
             intrinsics: [{extra}500, 500, 0, 0]\n  resolution: [640, 480]\n"
        );
        assert_eq!(axis(CalibrationFormat::Kalibr, &text), CENTRE);
    }
}

/// COLMAP's documentation of its output: the upper left corner of an image is (0, 0), the centre of the upper left pixel (0.5, 0.5).
#[test]
fn colmap_counts_corners_from_zero() {
    for parameters in ["PINHOLE 640 480 500 500 0.5 0.5", "OPENCV_FISHEYE 640 480 500 500 0.5 0.5 0.1 0 0 0"] {
        assert_eq!(axis(CalibrationFormat::Colmap, &format!("1 {parameters}\n")), CENTRE);
    }
}

/// The file of OCamCalib states it: `center: "row" and "column", starting from 0 (C convention)`; row first.
#[test]
fn ocam_counts_centres_from_zero_row_first() {
    let text = |row: f64, column: f64| format!("3 -218.6 0 0.00195\n0\n{row} {column}\n1 0 0\n480 640\n");
    assert_eq!(axis(CalibrationFormat::Ocam, &text(0.0, 0.0)), CENTRE);
    assert_eq!(axis(CalibrationFormat::Ocam, &text(0.0, 7.0)), DVec2::new(7.5, 0.5));
}

/// NCore's documentation of its f-theta parameters: the principal point follows NVIDIA's convention for f-theta cameras, in
/// which pixel indices are the centres of pixels.
#[test]
fn f_theta_counts_centres_from_zero() {
    let rig = r#"{"Model": "ftheta", "width": "640", "height": "480", "cx": "0", "cy": "0", "polynomial": "0 0.002",
                  "polynomial-type": "pixeldistance-to-angle"}"#;
    assert_eq!(axis(CalibrationFormat::FTheta, rig), CENTRE);
    let ncore = r#"{"resolution": [640, 480], "principal_point": [0, 0], "reference_poly": "ANGLE_TO_PIXELDIST",
                    "angle_to_pixeldist_poly": [0, 500], "pixeldist_to_angle_poly": [0, 0.002], "max_angle": 1.5,
                    "linear_cde": [0.999, 0.001, -0.002]}"#;
    assert_eq!(axis(CalibrationFormat::FTheta, ncore), CENTRE);
}
