//! Camera models against OpenCV and COLMAP (tests/oracles/cameras.py).

use etendue_projection::model::{
    Division, ExtendedUnified, FieldOfView, KannalaBrandt, Panorama, Perspective, ThinPrismFisheye, Unified,
};
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Calibration, CameraMatrix, Model};
use glam::{DVec2, DVec3};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../tests/oracles/figures/cameras.json");

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

/// The camera sees the table's points where the other program does, whose pixel centres are `offset` lower, and looks
/// from there to where they are.
fn compare(camera: &Calibration, table: &Value, offset: f64) {
    let (points, pixels) = (list(&table["points_m"]), list(&table["pixels"]));
    assert_eq!((points.len(), pixels.len()), (40, 40));
    for (point, pixel) in points.iter().zip(pixels) {
        let (point, pixel) = (DVec3::from_slice(&numbers(point)), DVec2::from_slice(&numbers(pixel)) + offset);
        let ours = camera.project(point).unwrap_or_else(|| panic!("{point} is not seen by {camera:?}"));
        assert!((ours - pixel).length() < TOLERANCE_PX, "{ours} for {pixel}: {camera:?}");
        let back = camera.unproject(pixel).unwrap_or_else(|| panic!("{pixel} sees nothing: {camera:?}"));
        // A direction to 1e-9 px at the focal lengths of the figures, 250 px and more.
        assert!((back - point.normalize()).length() < 4e-12, "{back} for {point}: {camera:?}");
    }
}

#[test]
fn perspective_with_all_fourteen_coefficients_is_opencv_s() {
    let figures = figures();
    let matrix = matrix(&figures["opencv"]["matrix"]);
    for table in list(&figures["opencv"]["perspective"]) {
        let model = Perspective::from_opencv(&numbers(&table["coefficients"])).expect("legal");
        compare(&camera(Model::Perspective(model), matrix), table, 0.5);
    }
}

#[test]
fn the_polynomial_fisheye_is_opencv_s() {
    let figures = figures();
    let matrix = matrix(&figures["opencv"]["skewed"]);
    for table in list(&figures["opencv"]["fisheye"]) {
        let k = numbers(&table["coefficients"]).try_into().expect("four");
        compare(&camera(Model::KannalaBrandt(KannalaBrandt::new(k).expect("legal")), matrix), table, 0.5);
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
        compare(&camera(Model::Unified(model), matrix), table, 0.5);
    }
}

#[test]
fn every_model_of_colmap_is_in_the_family() {
    let figures = figures();
    let tables = list(&figures["colmap"]);
    assert_eq!(tables.len(), 18);
    for table in tables {
        let name = table["model"].as_str().expect("a name");
        compare(&colmap(name, &numbers(&table["parameters"])), table, 0.0);
    }
}

fn colmap(name: &str, p: &[f64]) -> Calibration {
    let one = ["SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "SIMPLE_RADIAL_FISHEYE", "RADIAL_FISHEYE"];
    let one = one.contains(&name) || ["SIMPLE_DIVISION", "SIMPLE_FISHEYE"].contains(&name);
    let (f, rest) = if one { ([p[0], p[0]], &p[1..]) } else { ([p[0], p[1]], &p[2..]) };
    if name == "EQUIRECTANGULAR" {
        let [fx, fy] = [p[0] / core::f64::consts::TAU, p[1] / core::f64::consts::PI];
        let matrix = CameraMatrix { fx, fy, skew: 0.0, cx: 0.5 * p[0], cy: 0.5 * p[1] };
        return camera(Model::Panorama(Panorama::Equirectangular), matrix);
    }
    let matrix = CameraMatrix { fx: f[0], fy: f[1], skew: 0.0, cx: rest[0], cy: rest[1] };
    camera(colmap_model(name, &rest[2..]), matrix)
}

fn colmap_model(name: &str, k: &[f64]) -> Model {
    let fisheye = |k: &[f64]| {
        let mut six = [0.0; 6];
        six[..k.len()].copy_from_slice(k);
        KannalaBrandt::long(six).expect("legal")
    };
    let opencv = |k: &[f64]| Model::Perspective(Perspective::from_opencv(k).expect("legal"));
    let thin = |fisheye, terms| Model::ThinPrismFisheye(ThinPrismFisheye::new(fisheye, terms).expect("legal"));
    match (name, k) {
        ("SIMPLE_PINHOLE" | "PINHOLE", []) => opencv(&[]),
        ("SIMPLE_RADIAL", [k1]) => opencv(&[*k1, 0.0, 0.0, 0.0]),
        ("RADIAL", [k1, k2]) => opencv(&[*k1, *k2, 0.0, 0.0]),
        ("OPENCV" | "FULL_OPENCV", k) => opencv(k),
        ("SIMPLE_FISHEYE" | "FISHEYE" | "SIMPLE_RADIAL_FISHEYE" | "RADIAL_FISHEYE" | "OPENCV_FISHEYE", k) => {
            Model::KannalaBrandt(fisheye(k))
        }
        ("FOV", [omega]) => Model::FieldOfView(FieldOfView::new(*omega).expect("legal")),
        ("SIMPLE_DIVISION" | "DIVISION", [k]) => Model::Division(Division::new(*k).expect("legal")),
        ("EUCM", [alpha, beta]) => Model::ExtendedUnified(ExtendedUnified::new(*alpha, *beta).expect("legal")),
        ("THIN_PRISM_FISHEYE", &[k1, k2, p1, p2, k3, k4, s1, s3]) => {
            let numerator = [k1, k2, k3, k4];
            let prism = [s1, 0.0, s3, 0.0];
            thin(fisheye(&[]), DistortionTerms { numerator, tangential: [p1, p2], prism, ..Default::default() })
        }
        ("RAD_TAN_THIN_PRISM_FISHEYE", &[_, _, _, _, _, _, p0, p1, s0, s1, s2, s3]) => {
            let prism = [s0, s1, s2, s3];
            // Aria's p0 goes with x as OpenCV's p2 does.
            thin(fisheye(&k[..6]), DistortionTerms { tangential: [p1, p0], prism, ..Default::default() })
        }
        _ => panic!("{name} with {} parameters", k.len()),
    }
}
