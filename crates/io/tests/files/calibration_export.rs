//! Exported cameras read back as the same camera.

use etendue_core::CameraPose;
use etendue_io::calibration::export::{NamedCamera, colmap, kalibr, ros};
use etendue_io::calibration::{CalibrationFormat, read_calibration};
use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FieldOfView, Ideal, KannalaBrandt, Perspective, ThinPrismFisheye, Unified,
};
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Calibration, CameraMatrix, Model};
use glam::{DMat3, DVec2, DVec3};

const MATRIX: CameraMatrix = CameraMatrix { fx: 412.5, fy: 408.0, skew: 0.0, cx: 319.75, cy: 242.25 };

fn camera(model: Model) -> Calibration {
    Calibration::new(model, MATRIX, [640, 480]).expect("a legal camera")
}

fn perspective(k: &[f64]) -> Model {
    Model::Perspective(Perspective::from_opencv(k).expect("legal"))
}

fn unified(k: [f64; 4]) -> Model {
    let terms = DistortionTerms { numerator: [k[0], k[1], 0.0, 0.0], tangential: [k[2], k[3]], ..Default::default() };
    Model::Unified(Unified::new(0.8, terms).expect("legal"))
}

fn thin_prism(k: [f64; 6], terms: DistortionTerms) -> Model {
    Model::ThinPrismFisheye(ThinPrismFisheye::new(KannalaBrandt::long(k).expect("legal"), terms).expect("legal"))
}

/// Checks that both give the same projection over the whole image.
#[track_caller]
fn assert_same(actual: &Calibration, expected: &Calibration, label: &str) {
    assert_eq!(actual.size_px(), expected.size_px(), "{label}");
    let mut visible_count = 0;
    for i in 0..81 {
        let at = DVec2::new(f64::from(i % 9) * 80.0, f64::from(i / 9) * 60.0);
        let Some(direction) = expected.unproject(at) else { continue };
        let again = actual.project(direction).unwrap_or_else(|| panic!("{label}: {at} is not seen"));
        // Rounding of some hundred px.
        assert!((again - at).length() < 1e-10, "{label}: {again} for {at}");
        visible_count += 1;
    }
    assert!(visible_count > 40, "{label}");
}

fn read(name: &str, text: &str, format: CalibrationFormat, camera: Option<&str>) -> Calibration {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, text).expect("written");
    read_calibration(&file, format, camera).unwrap_or_else(|error| panic!("{error}\n{text}")).calibration
}

/// Every model with the formats that support it.
fn models() -> Vec<(&'static str, Model, [bool; 3])> {
    let prism = DistortionTerms {
        numerator: [-0.012, 0.004, -0.002, 0.0003],
        tangential: [0.0007, -0.0003],
        prism: [0.0011, 0.0, -0.0009, 0.0],
        ..Default::default()
    };
    let angle = DistortionTerms {
        tangential: [0.0007, -0.0003],
        prism: [0.0011, -0.0009, 0.0002, -0.0001],
        ..Default::default()
    };
    let twelve = [-0.2, 0.05, 0.0011, -0.0008, 0.01, 0.02, -0.005, 0.001, 0.002, -0.001, 0.0015, 0.0004];
    let fourteen = [&twelve[..], &[0.06, -0.11]].concat();
    vec![
        ("pinhole", perspective(&[]), [true, true, true]),
        ("rectilinear", Model::Ideal(Ideal::Rectilinear), [true, true, true]),
        ("four", perspective(&[-0.2, 0.05, 0.0011, -0.0008]), [true, true, true]),
        ("five", perspective(&[-0.2, 0.05, 0.0011, -0.0008, 0.01]), [true, false, true]),
        ("eight", perspective(&twelve[..8]), [true, false, true]),
        ("twelve", perspective(&twelve), [true, false, false]),
        ("fourteen", perspective(&fourteen), [true, false, false]),
        (
            "fisheye",
            Model::KannalaBrandt(KannalaBrandt::new([-0.012, 0.0042, -0.0031, 0.0006]).expect("legal")),
            [true, true, true],
        ),
        ("equidistant", Model::Ideal(Ideal::Equidistant), [true, true, true]),
        ("field of view", Model::FieldOfView(FieldOfView::new(0.93).expect("legal")), [false, true, true]),
        ("unified", unified([-0.1, 0.02, 0.0007, -0.0003]), [false, true, false]),
        (
            "extended unified",
            Model::ExtendedUnified(ExtendedUnified::new(0.62, 1.1).expect("legal")),
            [false, true, true],
        ),
        ("double sphere", Model::DoubleSphere(DoubleSphere::new(-0.2, 0.55).expect("legal")), [false, true, false]),
        ("division", Model::Division(Division::new(-0.15).expect("legal")), [false, false, true]),
        ("thin prism", thin_prism([0.0; 6], prism), [false, false, true]),
        ("prism of angles", thin_prism([-0.012, 0.004, -0.002, 0.0006, -0.0002, 0.00002], angle), [false, false, true]),
        ("equisolid", Model::Ideal(Ideal::Equisolid), [false, false, false]),
    ]
}

#[test]
fn every_model_that_a_format_knows_is_the_same_camera_in_it() {
    for (label, model, known) in models() {
        let calibration = camera(model);
        let named = NamedCamera { name: "left", calibration: &calibration };
        let ros = ros::camera_info(&named, 0.0);
        assert_eq!(ros.is_ok(), known[0], "{label}: {ros:?}");
        if let Ok(text) = ros {
            assert_same(&read("ros.yaml", &text, CalibrationFormat::Ros, Some("left")), &calibration, label);
        }
        let chain = kalibr::intrinsics(&named).map(|intrinsics| {
            let pose = CameraPose { position_m: DVec3::ZERO, rotation: DMat3::IDENTITY };
            kalibr::camchain(Some("car"), &[kalibr::ChainLink { camera: named, intrinsics, pose }], &[])
        });
        assert_eq!(chain.is_ok(), known[1], "{label}: {chain:?}");
        if let Ok(text) = chain {
            assert_same(&read("camchain.yaml", &text, CalibrationFormat::Kalibr, Some("cam0")), &calibration, label);
        }
        let line = colmap::camera(&named);
        assert_eq!(line.is_ok(), known[2], "{label}: {line:?}");
        if let Ok(line) = line {
            let text = colmap::cameras(&[line], &[]);
            assert_same(&read("cameras.txt", &text, CalibrationFormat::Colmap, Some("1")), &calibration, label);
        }
    }
}

/// Kalibr's own reader (aslam_cv_cameras, ParametersBase.py) knows these names and numbers of coefficients.
const KALIBR_MODELS: [[&str; 2]; 6] = [
    ["pinhole", "radtan"],
    ["pinhole", "equidistant"],
    ["pinhole", "fov"],
    ["omni", "radtan"],
    ["eucm", "none"],
    ["ds", "none"],
];

#[test]
fn chains_have_the_names_that_kalibr_reads() {
    for (label, model, known) in models() {
        let calibration = camera(model);
        let named = NamedCamera { name: "left", calibration: &calibration };
        let Ok(intrinsics) = kalibr::intrinsics(&named) else { continue };
        assert!(known[1], "{label}");
        let pose = CameraPose { position_m: DVec3::ZERO, rotation: DMat3::IDENTITY };
        let text = kalibr::camchain(None, &[kalibr::ChainLink { camera: named, intrinsics, pose }], &[]);
        let value = |key: &str| text.lines().find_map(|line| line.trim().strip_prefix(key)).expect("the key");
        let [camera, distortion] = [value("camera_model: "), value("distortion_model: ")];
        assert!(KALIBR_MODELS.contains(&[camera, distortion]), "{label}: {camera}, {distortion}");
        let count = |list: &str| list.split(',').filter(|number| number.contains('.')).count();
        let expected = if distortion == "none" {
            0
        } else if distortion == "fov" {
            1
        } else {
            4
        };
        assert_eq!(count(value("distortion_coeffs: ")), expected, "{label}");
    }
}

/// OpenCV's fisheye has the skew α fx in its camera matrix: u = fx (x + α y) + cx.
#[test]
fn ros_has_the_skew_of_a_fisheye() {
    let skewed = CameraMatrix { skew: -0.31, ..MATRIX };
    let fisheye = KannalaBrandt::new([-0.012, 0.0042, -0.0031, 0.0006]).expect("legal");
    let calibration = Calibration::new(Model::KannalaBrandt(fisheye), skewed, [640, 480]).expect("legal");
    let text = ros::camera_info(&NamedCamera { name: "left", calibration: &calibration }, 0.0).expect("a fisheye");
    assert!(text.contains("data: [412.5, -0.31, 319.25, 0.0, 408.0, 241.75, 0.0, 0.0, 1.0]"), "{text}");
    assert_same(&read("ros.yaml", &text, CalibrationFormat::Ros, Some("left")), &calibration, "skew");
}

#[test]
fn a_skew_of_a_perspective_camera_is_refused_by_all() {
    let skewed = CameraMatrix { skew: 0.8, ..MATRIX };
    let calibration = Calibration::new(perspective(&[]), skewed, [640, 480]).expect("legal");
    let named = NamedCamera { name: "left", calibration: &calibration };
    let refused = |message: Result<String, String>| {
        let message = message.expect_err("a skew");
        assert!(message.contains("the skew of 0.8 px"), "{message}");
    };
    refused(ros::camera_info(&named, 0.0));
    refused(kalibr::intrinsics(&named).map(|_| String::new()));
    refused(colmap::camera(&named));
}
