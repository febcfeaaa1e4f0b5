//! The radial distortion, the camera matrix and the pixel convention against OpenCV (tests/oracles/distortion.py).

use etendue_projection::{CameraMatrix, DistortionDirection, RadialDistortion, Raster, Rectilinear};
use glam::{DVec2, DVec3};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/distortion.json");

const PRINCIPAL_DISTANCE_MM: f64 = 6.5;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn rows(value: &Value) -> impl Iterator<Item = &Vec<Value>> {
    value.as_array().expect("rows").iter().map(|row| row.as_array().expect("a row"))
}

/// The raster whose camera matrix is that of the reference data.
fn raster(figures: &Value) -> Raster {
    let m = |row: usize, column: usize| number(&figures["matrix"][row][column]);
    let opencv = CameraMatrix { fx: m(0, 0), fy: m(1, 1), skew: 0.0, cx: m(0, 2), cy: m(1, 2) };
    let matrix = opencv.from_opencv();
    let pitch_mm = DVec2::new(PRINCIPAL_DISTANCE_MM / matrix.fx, PRINCIPAL_DISTANCE_MM / matrix.fy);
    let raster = Raster::new(640, 480, pitch_mm, DVec2::new(matrix.cx, matrix.cy)).expect("legal");
    let back = raster.camera_matrix(PRINCIPAL_DISTANCE_MM).to_opencv().rows();
    for (row, expected) in back.iter().zip(rows(&figures["matrix"])) {
        // Two divisions.
        assert!(row.iter().zip(expected).all(|(a, b)| (a - number(b)).abs() < 1e-12));
    }
    raster
}

#[test]
fn ideal_to_observed_in_focal_lengths_is_opencv_s_k1_k2() {
    let figures: Value = serde_json::from_str(FIGURES).expect("JSON");
    let raster = raster(&figures);
    let view = Rectilinear { principal_distance_mm: PRINCIPAL_DISTANCE_MM };
    let mut compared = 0;
    for lens in figures["lenses"].as_array().expect("lenses") {
        let [k1, k2] = [number(&lens["k1"]), number(&lens["k2"])];
        let d =
            RadialDistortion::new(DistortionDirection::IdealToObserved, k1, k2, PRINCIPAL_DISTANCE_MM).expect("legal");
        for (point, pixel) in rows(&figures["points_m"]).zip(rows(&lens["pixels"])) {
            let point = DVec3::new(number(&point[0]), number(&point[1]), number(&point[2]));
            let ideal_mm = view.project(point).expect("in front");
            let observed_mm = d.observed(ideal_mm).expect("before the fold");
            // OpenCV's centres are at integers.
            let pixel = DVec2::new(number(&pixel[0]), number(&pixel[1])) + 0.5;
            // Both work in f64 on coordinates below 1 000 px: a dozen roundings of 1e-13.
            assert!((raster.raster_px(observed_mm) - pixel).length() < 2e-12, "k1 {k1}, k2 {k2}");
            // And back: OpenCV's pixel to the ideal point, the project's bound of 1e-9 px.
            let back = d.ideal(raster.sensor_mm(pixel)).expect("before the fold");
            assert!((raster.raster_px(back) - raster.raster_px(ideal_mm)).length() < 1e-9);
            compared += 1;
        }
    }
    assert_eq!(compared, 200);
}
