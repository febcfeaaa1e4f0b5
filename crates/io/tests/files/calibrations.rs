//! Calibration files compared with the programs that define them: files and results of OpenCV and COLMAP (tests/oracles/cameras.py), the published formulas of
//! ROS, Kalibr and OCamCalib.

use std::path::{Path, PathBuf};

use etendue_core::maths::f64::{atan, atan2, tan};
use etendue_io::calibration::{CalibrationFormat, ImportedCamera, read_calibration};
use etendue_projection::Calibration;
use glam::{DVec2, DVec3};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/cameras.json");

/// Coordinates of some hundred px and some dozen roundings of 1e-13 px.
const TOLERANCE_PX: f64 = 1e-11;

fn written(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/calibrations").join(name)
}

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/calibrations").join(name)
}

fn read(file: &Path, format: CalibrationFormat, camera: Option<&str>) -> ImportedCamera {
    read_calibration(file, format, camera).unwrap_or_else(|error| panic!("{error}"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// Checks that the camera projects the table's points like the other program; its pixel centres are `offset` lower.
fn compare(camera: &Calibration, table: &Value, offset: f64) {
    let list = |key: &str| table[key].as_array().expect("a list").clone();
    let (points, pixels) = (list("points_m"), list("pixels"));
    assert_eq!((points.len(), pixels.len()), (40, 40));
    for (point, pixel) in points.iter().zip(&pixels) {
        let (point, pixel) = (DVec3::from_slice(&numbers(point)), DVec2::from_slice(&numbers(pixel)) + offset);
        let ours = camera.project(point).unwrap_or_else(|| panic!("{point} is not seen by {camera:?}"));
        assert!((ours - pixel).length() < TOLERANCE_PX, "{ours} for {pixel}: {camera:?}");
        let back = camera.unproject(pixel).unwrap_or_else(|| panic!("{pixel} sees nothing: {camera:?}"));
        // A direction to 1e-9 px at focal lengths of 100 px and more.
        assert!((back - point.normalize()).length() < 1e-11, "{back} for {point}: {camera:?}");
    }
}

#[test]
fn files_that_opencv_wrote_are_its_cameras() {
    let figures: Value = serde_json::from_str(FIGURES).expect("JSON");
    let opencv = &figures["opencv"];
    let cases = [
        ("opencv.yml", &opencv["perspective"][5]),
        ("opencv.json", &opencv["perspective"][3]),
        ("opencv_fisheye.yml", &opencv["fisheye"][1]),
        ("opencv_omnidir.yml", &opencv["mei"][0]),
    ];
    for (name, table) in cases {
        let camera = read(&written(name), CalibrationFormat::OpenCv, None);
        assert_eq!(camera.calibration.size_px(), [640, 480]);
        assert_eq!(camera.notes, ["ignored: avg_reprojection_error"]);
        compare(&camera.calibration, table, 0.5);
    }
}

#[test]
fn every_camera_that_colmap_wrote_is_its_camera() {
    let figures: Value = serde_json::from_str(FIGURES).expect("JSON");
    let tables = figures["colmap"].as_array().expect("a list");
    assert_eq!(tables.len(), 18);
    for (i, table) in tables.iter().enumerate() {
        let id = (i + 1).to_string();
        let camera = read(&written("cameras.txt"), CalibrationFormat::Colmap, Some(&id));
        assert_eq!(camera.name, id);
        compare(&camera.calibration, table, 0.0);
    }
}

/// Directions over a cone of 60° about the axis, as points at Z = 1.
fn rays() -> impl Iterator<Item = DVec3> {
    (-6..=6).flat_map(|i| (-6..=6).map(move |j| DVec3::new(0.2 * f64::from(i), 0.15 * f64::from(j), 1.0)))
}

/// k1, k2, p1, p2 (and k3) of the radial-tangential model.
fn radtan([x, y]: [f64; 2], [k1, k2, p1, p2, k3]: [f64; 5]) -> [f64; 2] {
    let s = x * x + y * y;
    let g = 1.0 + k1 * s + k2 * s * s + k3 * s * s * s;
    [x * g + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x), y * g + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y]
}

/// Checks that the camera sees every ray at the pixel of the definition, whose centres are at whole numbers.
fn follows(camera: &Calibration, focal: [f64; 2], centre: [f64; 2], definition: impl Fn(DVec3) -> [f64; 2]) {
    let mut visible_count = 0;
    for ray in rays() {
        let [x, y] = definition(ray);
        let expected = DVec2::new(focal[0] * x + centre[0] + 0.5, focal[1] * y + centre[1] + 0.5);
        // Definitions continue beyond a fold; the cameras do not.
        let Some(ours) = camera.project(ray) else { continue };
        visible_count += 1;
        assert!((ours - expected).length() < TOLERANCE_PX, "{ours} for {expected}: {camera:?}");
    }
    assert!(visible_count > 100, "{visible_count}");
}

#[test]
fn a_camera_info_file_is_what_ros_defines() {
    // sensor_msgs/CameraInfo: plumb_bob is k1, k2, t1, t2, k3 on the raw image.
    let camera = read(&sample("camera_info.yaml"), CalibrationFormat::Ros, Some("narrow_stereo"));
    assert_eq!(camera.notes, ["ignored: rectification_matrix, projection_matrix"]);
    let k = [-0.361976, 0.110510, 0.001014, 0.000505, 0.0];
    let (focal, centre) = ([438.783367, 437.302876], [305.593336, 243.738352]);
    follows(&camera.calibration, focal, centre, |p| radtan([p.x / p.z, p.y / p.z], k));
    assert!(camera.calibration.check().is_ok());
}

#[test]
fn every_camera_of_a_kalibr_chain_is_what_kalibr_defines() {
    let chain = sample("camchain.yaml");
    let camera = |name: &str| read(&chain, CalibrationFormat::Kalibr, Some(name)).calibration;
    let flat = |p: DVec3| [p.x / p.z, p.y / p.z];
    let k = [-0.2831, 0.0726, 0.0003, -0.0002, 0.0];
    follows(&camera("cam0"), [458.654, 457.296], [367.215, 248.375], |p| radtan(flat(p), k));
    follows(&camera("cam1"), [190.978, 190.973], [254.931, 256.897], |p| {
        let r = DVec2::from(flat(p)).length();
        let (a, [k1, k2, k3, k4]) = (atan(r), [-0.0131, 0.0207, -0.0124, 0.0025]);
        let s = a * a;
        let distorted = a * (1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4))));
        flat(p).map(|x| if r > 0.0 { x * distorted / r } else { x })
    });
    follows(&camera("cam2"), [712.4, 711.8], [359.1, 243.6], |p| {
        let below = p.z + 1.27 * p.length();
        radtan([p.x / below, p.y / below], [-0.32, 0.08, 0.0005, -0.0004, 0.0])
    });
    follows(&camera("cam3"), [313.21, 313.24], [638.66, 514.40], |p| {
        let (xi, alpha, d1) = (-0.2702, 0.5727, p.length());
        let forward = xi * d1 + p.z;
        let d2 = (p.x * p.x + p.y * p.y + forward * forward).sqrt();
        [p.x, p.y].map(|x| x / (alpha * d2 + (1.0 - alpha) * forward))
    });
    follows(&camera("cam4"), [380.95, 380.94], [640.12, 515.37], |p| {
        let (alpha, beta) = (0.6193, 1.0717);
        let d = (beta * (p.x * p.x + p.y * p.y) + p.z * p.z).sqrt();
        [p.x, p.y].map(|x| x / (alpha * d + (1.0 - alpha) * p.z))
    });
    follows(&camera("cam5"), [256.2, 254.4], [319.5, 241.3], |p| {
        let (omega, r) = (0.9268, DVec2::from(flat(p)).length());
        let distorted = atan(2.0 * r * tan(0.5 * omega)) / omega;
        flat(p).map(|x| if r > 0.0 { x * distorted / r } else { x })
    });
    let notes = read(&chain, CalibrationFormat::Kalibr, Some("cam1")).notes;
    assert_eq!(notes, ["ignored: T_cn_cnm1, cam_overlaps, rostopic, timeshift_cam_imu"]);
}

#[test]
fn an_ocam_file_is_what_its_toolbox_defines() {
    let camera = read(&sample("calib_results.txt"), CalibrationFormat::Ocam, None);
    assert_eq!(camera.calibration.size_px(), [640, 480]);
    assert!(camera.notes[0].contains("inverse polynomial deviates from it by up to 0."), "{:?}", camera.notes);
    let (row0, column0, [c, d, e]) = (241.25, 319.8, [0.9991, 0.00031, -0.00017]);
    for (i, j) in (0..48).flat_map(|i| (0..64).map(move |j| (10 * i, 10 * j))) {
        // cam2world of the toolbox: its first axis goes down the rows, its second along them, its third backwards.
        let (u, v) = (f64::from(i) - row0, f64::from(j) - column0);
        let inverse = 1.0 / (c - d * e);
        let (x, y) = (inverse * (u - d * v), inverse * (-e * u + c * v));
        let r = (x * x + y * y).sqrt();
        let z = -2.186e2 + r * r * (1.95e-3 + r * (-1.6e-6 + r * 6.9e-9));
        let pixel = DVec2::new(f64::from(j) + 0.5, f64::from(i) + 0.5);
        let direction = camera.calibration.unproject(pixel).expect("seen");
        // A direction from a polynomial of some hundred px: a dozen roundings of 1e-16.
        assert!((direction - DVec3::new(y, x, -z).normalize()).length() < 1e-14, "{direction} at {pixel}");
        // And the field passes 90° where the polynomial changes its sign.
        assert_eq!(direction.z < 0.0, z > 0.0);
        let back = camera.calibration.project(direction).expect("seen");
        assert!((back - pixel).length() < 1e-9 && atan2(r, -z) < 3.0);
    }
}

#[test]
fn a_camera_of_several_is_chosen_by_its_name() {
    let error_text = |name: &str, format, camera| {
        let file = if name == "cameras.txt" { written(name) } else { sample(name) };
        read_calibration(&file, format, camera).expect_err("wrong").what().to_owned()
    };
    let chain = "contains the cameras cam0, cam1, cam2, cam3, cam4, cam5; select one by its name";
    assert_eq!(error_text("camchain.yaml", CalibrationFormat::Kalibr, None), chain);
    assert!(
        error_text("camchain.yaml", CalibrationFormat::Kalibr, Some("cam9"))
            .contains("no camera \"cam9\"; it contains cam0")
    );
    assert!(error_text("cameras.txt", CalibrationFormat::Colmap, None).contains("select one by its id"));
    assert!(error_text("camera_info.yaml", CalibrationFormat::Ros, Some("wide")).contains("narrow_stereo"));
    assert!(error_text("calib_results.txt", CalibrationFormat::Ocam, Some("wide")).contains("has no name"));
}

/// Message for a text, with its line.
fn located_error(text: &str, format: CalibrationFormat) -> (Option<usize>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, text).expect("written");
    let error = read_calibration(&file, format, None).expect_err("wrong");
    (error.line(), error.what().to_owned())
}

#[test]
fn faults_name_the_line_and_what_was_expected() {
    let ros = std::fs::read_to_string(sample("camera_info.yaml")).expect("text");
    let kalibr = "cam0:\n  camera_model: pinhole\n  distortion_model: equi\n  distortion_coeffs: [0, 0, 0, 0]\n  \
                  intrinsics: [100, 100, 50, 50]\n  resolution: [100, 100]\n";
    let ocam = std::fs::read_to_string(sample("calib_results.txt")).expect("text");
    let opencv = std::fs::read_to_string(written("opencv.yml")).expect("text");
    use CalibrationFormat::{Colmap, Kalibr, Ocam, OpenCv, OpenCvFisheye, Ros};
    let cases = [
        (Ros, ros.replace("plumb_bob", "thin_film"), Some(8), "plumb_bob, rational_polynomial, equidistant"),
        (Ros, ros.replace("plumb_bob", "equidistant"), Some(10), "expected k1, k2, k3, k4"),
        (Ros, ros.replace("plumb_bob", "rational_polynomial"), Some(10), "rational_polynomial has 8 or 12 or 14"),
        (Ros, ros.replace("438.783367, 0.000000", "438.783367"), Some(7), "rows × cols = 3 × 3"),
        (Ros, ros.replace("438.783367", "nan"), Some(7), "\"nan\"; expected a finite number"),
        (Ros, ros.replace("438.783367", "0"), Some(5), "positive fx"),
        (Ros, ros.replace("image_width: 640\n", ""), Some(1), "expected the key image_width; found image_height"),
        (Ros, ros.replace("image_width: 640", "image_width: -1"), Some(1), "number of pixels"),
        (Ros, ros.replace("camera_name", "image_width"), Some(3), "twice"),
        (Kalibr, kalibr.replace("pinhole", "fish"), Some(2), "expected \"pinhole\", \"omni\", \"eucm\" or \"ds\""),
        (Kalibr, kalibr.replace("equi", "poly"), Some(3), "expected \"radtan\", \"equidistant\", \"fov\" or \"none\""),
        (Kalibr, kalibr.replace("pinhole", "ds"), Some(5), "expected 6: xi, alpha"),
        (Kalibr, kalibr.replace("equi", "none"), Some(4), "expected []"),
        (Kalibr, kalibr.replace("[100, 100]", "[100]"), Some(6), "[width, height]"),
        (
            Colmap,
            "1 SIMPLE_RADIAL 640 480 500 320 240\n".into(),
            Some(1),
            "the number of parameters is 3; the model SIMPLE_RADIAL has 4",
        ),
        (Colmap, "# no\n1 FISH 640 480 1\n".into(), Some(2), "expected one of SIMPLE_PINHOLE, SIMPLE_RADIAL"),
        (Colmap, "1 PINHOLE 640\n".into(), Some(1), "ends before the height"),
        (Colmap, "# none\n".into(), None, "contains no camera"),
        (Ocam, ocam.replace("5 -2.186", "6 -2.186"), Some(3), "the count is 6, but 5 numbers follow"),
        (Ocam, ocam.replace("-2.186000e+02", "2.186000e+02"), Some(3), "a0 = 218.6; expected a negative number"),
        (Ocam, ocam.replace("480 640", ""), None, "ends before the image size"),
        (Ocam, ocam.replace("480 640", "480 640\n1"), Some(20), "a sixth line"),
        (OpenCv, opencv.replace("812.5, 0.,", "812.5, 1.,"), Some(5), "the skew is 1 px"),
        (OpenCv, opencv.replace("camera_matrix", "matrix"), Some(3), "camera_matrix or cameraMatrix or K"),
        (OpenCvFisheye, opencv, Some(10), "the number of values is 14; expected k1, k2, k3, k4"),
        (OpenCv, "{\"a\": ".into(), None, "not YAML or JSON"),
    ];
    let wrong = cases.into_iter().filter_map(|(format, text, line, expected)| {
        let (at, what) = located_error(&text, format);
        let right = what.contains(expected) && (line.is_none() || at == line);
        (!right).then(|| format!("{format:?}: line {at:?}: {what} (expected {line:?}: {expected})"))
    });
    assert_eq!(wrong.collect::<Vec<_>>(), Vec::<String>::new());
}
