//! NVIDIA's f-theta files compared with their published formulas: the angle for a pixel's distance by a polynomial, and the linear term [c d; e 1] applied to
//! the pixel's offset first.

use etendue_core::maths::f64::sin_cos;
use etendue_io::calibration::{CalibrationFormat, ImportedCamera, read_calibration};
use glam::{DMat2, DVec2, DVec3};

const RIG: &str = r#"{
  "rig": {
    "sensors": [
      {"name": "lidar:top", "properties": {}},
      {"name": "camera:front:wide:120fov", "properties": {
        "Model": "ftheta", "cx": "1927.5", "cy": "1096.25", "width": "3848", "height": "2168",
        "polynomial": "0.0 5.42e-4 -1.9e-9 4.1e-12 -6.2e-16", "polynomial-type": "pixeldistance-to-angle",
        "linear-c": 0.9995, "linear-d": 2.1e-4, "linear-e": -1.3e-4, "do-not-use": "x"
      }},
      {"name": "camera:rear:tele:30fov", "properties": {
        "Model": "ftheta", "cx": "960", "cy": "540", "width": "1920", "height": "1080", "bw-poly": "0 2.6e-4 0 0 0",
        "linear-c": 0.0, "linear-d": 0.0, "linear-e": 0.0
      }}
    ]
  }
}"#;

const NCORE: &str = r#"{"camera_model_type": "ftheta", "camera_model_parameters": {
  "resolution": [960, 744], "shutter_type": "ROLLING_TOP_TO_BOTTOM", "external_distortion_parameters": null,
  "principal_point": [477.86, 371.405], "reference_poly": "ANGLE_TO_PIXELDIST",
  "pixeldist_to_angle_poly": [0.0, 0.0021, 0.0, 0.0, 0.0, 0.0],
  "angle_to_pixeldist_poly": [0.0, 473.61, -9.5876, 24.947, -42.339, 15.141],
  "max_angle": 1.3461, "linear_cde": [0.99976, 6.278e-05, -0.00010062]}}"#;

fn read(text: &str, camera: Option<&str>) -> Result<ImportedCamera, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("camera.json");
    std::fs::write(&file, text).expect("written");
    read_calibration(&file, CalibrationFormat::FTheta, camera)
        .map_err(|error| format!("{}: {}", error.line().unwrap_or(0), error.what()))
}

/// Σ cᵢ xⁱ.
fn value(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The linear term [c d; e 1].
fn linear([c, d, e]: [f64; 3]) -> DMat2 {
    DMat2::from_cols_array(&[c, e, d, 1.0])
}

#[test]
fn a_rig_s_pixels_look_where_its_polynomial_says() {
    let camera = read(RIG, Some("camera:front:wide:120fov")).expect("a rig");
    assert_eq!(camera.name, "camera:front:wide:120fov");
    assert_eq!(
        (camera.calibration.size_px(), &camera.notes[..]),
        ([3848, 2168], &["ignored: do-not-use".to_owned()][..])
    );
    let (c, back) = ([0.0, 5.42e-4, -1.9e-9, 4.1e-12, -6.2e-16], linear([0.9995, 2.1e-4, -1.3e-4]).inverse());
    for (column, row) in (0..40).flat_map(|i| (0..22).map(move |j| (100 * i, 100 * j))) {
        let offset = back * DVec2::new(f64::from(column) - 1927.5, f64::from(row) - 1096.25);
        let (sin, cos) = sin_cos(value(&c, offset.length()));
        let expected = (offset.normalize() * sin).extend(cos);
        let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
        let direction = camera.calibration.unproject(at).expect("seen");
        // A dozen roundings of numbers up to 3.
        assert!((direction - expected).length() < 1e-14, "{direction} for {expected} at {at}");
        let back = camera.calibration.project(direction).expect("seen");
        assert!((back - at).length() < 1e-9, "{back} for {at}");
    }
    // A linear term of zeros is none (DriveWorks, dwFThetaCameraConfig), and bw-poly runs from the distance.
    let tele = read(RIG, Some("camera:rear:tele:30fov")).expect("a rig").calibration;
    let (sin, cos) = sin_cos(2.6e-4 * 500.0);
    let direction = tele.unproject(DVec2::new(1460.5, 540.5)).expect("seen");
    assert!((direction - DVec3::new(sin, 0.0, cos)).length() < 1e-15, "{direction}");
}

#[test]
fn an_ncore_camera_projects_by_its_polynomial_up_to_its_angle() {
    let camera = read(NCORE, None).expect("a camera");
    assert_eq!(camera.notes, ["ignored: shutter_type, pixeldist_to_angle_poly"]);
    let (c, there) = ([0.0, 473.61, -9.5876, 24.947, -42.339, 15.141], linear([0.99976, 6.278e-5, -1.0062e-4]));
    for (i, j) in (1..14).flat_map(|i| (0..16).map(move |j| (i, j))) {
        let (angle, azimuth) = (0.1 * f64::from(i), 0.4 * f64::from(j));
        let ((sin, cos), (y, x)) = (sin_cos(angle), sin_cos(azimuth));
        let pixel = camera.calibration.project(DVec3::new(x * sin, y * sin, cos));
        let expected = there * (DVec2::new(x, y) * value(&c, angle)) + DVec2::new(477.86, 371.405) + 0.5;
        if angle < 1.3461 {
            // Some hundred px and a dozen roundings.
            assert!((pixel.expect("seen") - expected).length() < 1e-11, "{pixel:?} for {expected}");
        } else {
            assert!(pixel.is_none());
        }
    }
}

#[test]
fn faults_name_the_line_and_what_was_expected() {
    let cases = [
        (RIG.to_owned(), None, "select one by its name"),
        (
            RIG.to_owned(),
            Some("camera:side"),
            "contains no f-theta camera \"camera:side\"; it contains camera:front:wide",
        ),
        (RIG.replace("\"ftheta\"", "\"pinhole\""), None, "2: contains no f-theta camera"),
        (
            RIG.replace("pixeldistance-to-angle", "sideways"),
            Some("camera:front:wide:120fov"),
            "7: unknown polynomial type sideways",
        ),
        (RIG.replace("\"0.0 5.42e-4", "\"0.1 5.42e-4"), Some("camera:front:wide:120fov"), "7: c0 = 0.1; expected 0"),
        (RIG.replace("5.42e-4", "many"), Some("camera:front:wide:120fov"), "7: found \"many\""),
        (
            RIG.replace("\"linear-c\": 0.9995", "\"linear-c\": -1"),
            Some("camera:front:wide:120fov"),
            "c is -1; expected a positive",
        ),
        (NCORE.replace("parameters\": null", "parameters\": {\"a\": 1}"), None, "2: distortion by a windscreen"),
        (NCORE.replace("\"resolution\": [960, 744]", "\"resolution\": [960]"), None, "2: expected [width, height]"),
        (NCORE.replace("\"max_angle\": 1.3461", "\"max_angle\": 0"), None, "the greatest angle = 0"),
        ("{\"Model\": \"kannala\"}".to_owned(), None, "1: expected the model \"ftheta\""),
    ];
    for (text, camera, expected) in cases {
        let message = read(&text, camera).expect_err("wrong");
        assert!(message.contains(expected), "{message} (expected {expected})");
    }
}

#[test]
fn a_polynomial_that_turns_back_inside_the_picture_is_refused() {
    // θ = 0.002 r − 2e-6 r² turns back at 500 px; the farthest corner is 612 px away.
    let text = r#"{"Model": "ftheta", "width": 1000, "height": 700, "cx": 499.5, "cy": 349.5,
                   "polynomial": "0 2e-3 -2e-6", "polynomial-type": "pixeldistance-to-angle"}"#;
    let message = read(text, None).expect("read").calibration.check().expect_err("folds").to_string();
    assert!(message.contains("folds the image over at a radius of 500.0"), "{message}");
}
