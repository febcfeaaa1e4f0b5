//! Camera models against OpenCV (tests/oracles/cameras.py); those of COLMAP are in crates/io, with its files.

use etendue_projection::model::{KannalaBrandt, Perspective, Unified};
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Calibration, CameraMatrix, Model};
use glam::{DVec2, DVec3};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/cameras.json");

/// The programs and this crate work in f64 on coordinates of some hundred px and angles that go through an arc tangent
/// of 2 units in the last place: some dozen roundings of 1e-13 px.
const TOLERANCE_PX: f64 = 1e-11;

fn figures() -> Value {
    serde_json::from_str(FIGURES).expect("JSON")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn numbers(value: &Value) -> Vec<f64> {
    list(value).iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// The raster's matrix of one of OpenCV.
fn matrix(rows: &Value) -> CameraMatrix {
    let m = |row: usize, column: usize| rows[row][column].as_f64().expect("a number");
    CameraMatrix { fx: m(0, 0), fy: m(1, 1), skew: m(0, 1), cx: m(0, 2), cy: m(1, 2) }.from_opencv()
}

fn camera(model: Model, matrix: CameraMatrix) -> Calibration {
    Calibration::new(model, matrix, [640, 480]).expect("legal")
}

/// Checks that the camera projects the table's points as the other program does (its pixel centres are at integers), and unprojects them to the
/// original directions.
fn compare(camera: &Calibration, table: &Value) {
    let (points, pixels) = (list(&table["points_m"]), list(&table["pixels"]));
    assert_eq!((points.len(), pixels.len()), (40, 40));
    for (point, pixel) in points.iter().zip(pixels) {
        let (point, pixel) = (DVec3::from_slice(&numbers(point)), DVec2::from_slice(&numbers(pixel)) + 0.5);
        let ours = camera.project(point).unwrap_or_else(|| panic!("{point} is not seen by {camera:?}"));
        assert!((ours - pixel).length() < TOLERANCE_PX, "{ours} for {pixel}: {camera:?}");
        let back = camera.unproject(pixel).unwrap_or_else(|| panic!("{pixel} sees nothing: {camera:?}"));
        // A direction to 1e-9 px at the focal lengths of the reference data, 250 px and more.
        assert!((back - point.normalize()).length() < 4e-12, "{back} for {point}: {camera:?}");
    }
}

#[test]
fn perspective_with_all_fourteen_coefficients_is_opencv_s() {
    let figures = figures();
    let matrix = matrix(&figures["opencv"]["matrix"]);
    for table in list(&figures["opencv"]["perspective"]) {
        let model = Perspective::from_opencv(&numbers(&table["coefficients"])).expect("legal");
        compare(&camera(Model::Perspective(model), matrix), table);
    }
}

#[test]
fn the_polynomial_fisheye_is_opencv_s() {
    let figures = figures();
    let matrix = matrix(&figures["opencv"]["skewed"]);
    for table in list(&figures["opencv"]["fisheye"]) {
        let k = numbers(&table["coefficients"]).try_into().expect("four");
        compare(&camera(Model::KannalaBrandt(KannalaBrandt::new(k).expect("legal")), matrix), table);
    }
}

#[test]
fn the_unified_model_is_opencv_s() {
    let figures = figures();
    let matrix = matrix(&figures["opencv"]["skewed"]);
    for table in list(&figures["opencv"]["mei"]) {
        let [k1, k2, p1, p2] = numbers(&table["coefficients"]).try_into().expect("four");
        let terms = DistortionTerms { numerator: [k1, k2, 0.0, 0.0], tangential: [p1, p2], ..Default::default() };
        let model = Unified::new(table["xi"].as_f64().expect("a number"), terms).expect("legal");
        compare(&camera(Model::Unified(model), matrix), table);
    }
}
