//! Calibration files as other programs and their users write them (tests/oracles/calibrations.py): every file is the camera that its own program reads.

use std::path::{Path, PathBuf};

use etendue_io::calibration::{CalibrationFormat, ImportedCamera, read_calibration};
use glam::{DVec2, DVec3};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/field_calibrations.json");

/// Coordinates of some hundred px and some dozen roundings of 1e-13 px; numbers of ORB-SLAM and of messages have all their digits.
const TOLERANCE_PX: f64 = 1e-10;

fn stored(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/field_calibrations").join(name)
}

fn format_of(name: &str) -> CalibrationFormat {
    match name {
        "opencv" => CalibrationFormat::OpenCv,
        "ros" => CalibrationFormat::Ros,
        "kalibr" => CalibrationFormat::Kalibr,
        "euroc" => CalibrationFormat::Euroc,
        "camodocal" => CalibrationFormat::Camodocal,
        "colmap" => CalibrationFormat::Colmap,
        other => panic!("no format {other}"),
    }
}

fn vectors(value: &Value) -> Vec<Vec<f64>> {
    let numbers = |row: &Value| row.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect();
    value.as_array().expect("a list").iter().map(numbers).collect()
}

/// Differences of the camera of a file from the figures.
fn differences(entry: &Value) -> Vec<String> {
    let file = entry["file"].as_str().expect("a name");
    let format = format_of(entry["format"].as_str().expect("a format"));
    let camera = match read_calibration(&stored(file), format, entry["camera"].as_str()) {
        Ok(camera) => camera,
        Err(error) => return vec![format!("{file}: {error}")],
    };
    let mut differences = Vec::new();
    let size: Option<Vec<u64>> =
        entry["size_px"].as_array().map(|size| size.iter().map(|side| side.as_u64().expect("a size")).collect());
    let ours = camera.states_size.then(|| camera.calibration.size_px().map(|side| side as u64).to_vec());
    if ours != size {
        differences.push(format!("{file}: the size is {ours:?}, not {size:?}"));
    }
    for (point, pixel) in vectors(&entry["points_m"]).iter().zip(vectors(&entry["pixels"])) {
        let (point, pixel) = (DVec3::from_slice(point), DVec2::from_slice(&pixel));
        let ours = camera.calibration.project(point);
        if ours.is_none_or(|ours| (ours - pixel).length() > TOLERANCE_PX) {
            differences.push(format!("{file}, {}: {ours:?} for {pixel} of {point}", entry["camera"]));
        }
    }
    differences
}

#[test]
fn every_file_is_the_camera_that_its_own_program_reads() {
    let figures: Value = serde_json::from_str(FIGURES).expect("JSON");
    let entries = figures["cameras"].as_array().expect("a list");
    let wrong: Vec<String> = entries.iter().flat_map(differences).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let files = std::fs::read_dir(stored("")).expect("the folder").count();
    let read: std::collections::BTreeSet<&str> = entries.iter().filter_map(|entry| entry["file"].as_str()).collect();
    assert_eq!(read.len(), files, "every file is read");
}

fn read(name: &str, text: &str, format: CalibrationFormat, camera: Option<&str>) -> Result<ImportedCamera, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, text).expect("written");
    read_calibration(&file, format, camera).map_err(|error| error.to_string())
}

fn text_of(name: &str) -> String {
    std::fs::read_to_string(stored(name)).expect("text")
}

/// Checks that a changed file is the same camera.
#[track_caller]
fn assert_same_camera(name: &str, format: CalibrationFormat, change: impl Fn(&str) -> String) {
    let original = text_of(name);
    let changed = change(&original);
    assert_ne!(original, changed);
    let expected = read("a.txt", &original, format, None).unwrap_or_else(|error| panic!("{error}")).calibration;
    let actual = read("b.txt", &changed, format, None).unwrap_or_else(|error| panic!("{error}\n{changed}")).calibration;
    assert_eq!(actual, expected);
}

#[test]
fn spellings_of_the_same_file_are_the_same_camera() {
    use CalibrationFormat::{Camodocal, Euroc, OpenCv, Ros};
    assert_same_camera("out_camera_data.yml", OpenCv, |text| text.replacen("%YAML 1.2", "%YAML:1.0", 1));
    assert_same_camera("out_camera_data.yml", OpenCv, |text| text.replace("camera_matrix", "CameraMatrix"));
    assert_same_camera("out_camera_data.yml", OpenCv, |text| text.replace("camera_matrix", "intrinsic_matrix"));
    assert_same_camera("out_camera_data.yml", OpenCv, |text| text.replace("distortion_coefficients", "Distortion"));
    assert_same_camera("out_camera_data.xml", OpenCv, |text| text.replace("type_id=\"opencv-matrix\"", ""));
    assert_same_camera("out_camera_data.xml", OpenCv, |text| {
        let image_size = "<image_size>640 480</image_size>";
        text.replace("<image_width>640</image_width>", image_size).replace("<image_height>480</image_height>", "")
    });
    assert_same_camera("out_camera_data.yml", OpenCv, |text| format!("{text}distortion_model: plumb_bob\n"));
    assert_same_camera("fisheye.xml", OpenCv, |text| {
        let model = "<camera_model>\"KANNALA_BRANDT\"</camera_model>";
        text.replace("<fisheye_model>1</fisheye_model>", model)
    });
    assert_same_camera("ros_plumb_bob.yaml", Ros, |text| text.replace("plumb_bob", "\"plumb_bob\""));
    assert_same_camera("ros1_echo.yaml", Ros, |text| text.replace("\n---\n", "\n"));
    assert_same_camera("euroc_radtan.yaml", Euroc, |text| text.replace("radial-tangential", "radtan"));
    assert_same_camera("euroc_radtan.yaml", Euroc, |text| text.replace("[640, 480]", "{width: 640, height: 480}"));
    assert_same_camera("camodocal_kannala_brandt.yaml", Camodocal, |text| text.replace("KANNALA", "Kannala"));
}

#[test]
fn cameras_of_a_list_have_their_names() {
    let text = r#"{"cameras": [
        {"name": "front", "size": [640, 480], "K": [[400, 0, 320], [0, 401, 240], [0, 0, 1]], "dist": [[0.1, 0, 0, 0, 0]]},
        {"name": "rear", "width": 320, "height": 240, "fx": 200, "fy": 201, "cx": 159.5, "cy": 119.5, "k1": -0.2}
    ]}"#;
    let read = |camera| read("a.json", text, CalibrationFormat::OpenCv, Some(camera));
    let rear = read("rear").expect("read").calibration;
    assert_eq!((rear.size_px(), rear.matrix().fx, rear.matrix().cx), ([320, 240], 200.0, 160.0));
    // (0.5, 0) is distorted to 0.5 (1 − 0.2 · 0.25) = 0.475: column 0.475 · 200 + 160.
    let image = rear.project(DVec3::new(0.5, 0.0, 1.0)).expect("seen");
    assert!((image - DVec2::new(255.0, 120.0)).length() < TOLERANCE_PX, "{image}");
    assert_eq!(read("front").expect("read").calibration.matrix().fy, 401.0);
    let message = read("left").expect_err("no such camera");
    assert!(message.contains("contains no camera \"left\"; it contains front, rear"), "{message}");
}

#[test]
fn notes_state_what_was_not_used_or_assumed() {
    let notes = |name: &str, format, camera| read_calibration(&stored(name), format, camera).expect("read").notes;
    use CalibrationFormat::{Camodocal, Euroc, Kalibr, OpenCv, Ros};
    let ignored = "ignored: calibration_time, nframes, board_width, flags, avg_reprojection_error";
    assert_eq!(notes("out_camera_data.xml", OpenCv, None), [ignored]);
    assert_eq!(notes("intrinsics.yml", OpenCv, Some("left")), ["ignored: M2, D2"]);
    assert_eq!(notes("maps.json", OpenCv, Some("rear")), ["ignored: front"]);
    assert_eq!(notes("camchain.yaml", Kalibr, Some("cam1")), ["ignored: T_cn_cnm1, cam_overlaps, rostopic"]);
    assert_eq!(notes("euroc_radtan.yaml", Euroc, None), ["ignored: comment, T_BS, rate_hz"]);
    let fitted =
        text_of("camodocal_scaramuzza.yaml").replacen("   p1: 0.", "   p1: 248.", 2).replacen("p1: 248.", "p1: 0.", 1);
    let fitted = read("a.yaml", &fitted, Camodocal, None).expect("read").notes;
    assert!(fitted[0].starts_with("the exact inverse is used"), "{fitted:?}");
    assert!(notes("camodocal_scaramuzza.yaml", Camodocal, None).is_empty());
    assert_eq!(notes("ros1_echo.yaml", Ros, None), ["ignored: R, P"]);
    assert_eq!(
        notes("ros1_echo_twice.txt", Ros, None),
        ["the file contains several messages; the first is used", "ignored: R, P"]
    );
    assert!(notes("ros_no_model.yaml", Ros, None)[0].contains("plumb_bob is assumed"));
    let binned = text_of("ros2_echo.yaml").replace("binning_x: 0", "binning_x: 2");
    let binned = read("a.yaml", &binned, Ros, None).expect("read").notes;
    assert!(binned[1].contains("binned or of a region"), "{binned:?}");
    let whole = text_of("ros1_echo.yaml").replace("  height: 0\n  width: 0", "  height: 480\n  width: 640");
    assert_eq!(read("a.yaml", &whole, Ros, None).expect("read").notes, ["ignored: R, P"]);
}

#[test]
fn what_changes_the_camera_is_refused_by_name() {
    use CalibrationFormat::{Camodocal, Euroc, Kalibr, OpenCv, OpenCvFisheye, Ros};
    let xml = text_of("out_camera_data.xml");
    let ros = text_of("ros_plumb_bob.yaml");
    let chain = text_of("camchain.yaml");
    let mei = text_of("camodocal_mei.yaml");
    let euroc = text_of("euroc_radtan.yaml");
    let cases = [
        (
            OpenCv,
            xml.replace("opencv_storage", "scene"),
            "a.txt:2: the root element is <scene>; expected <opencv_storage>",
        ),
        (
            OpenCv,
            xml.replace("<camera_matrix ", "<matrix ").replace("</camera_matrix>", "</matrix>"),
            "expected the key camera_matrix",
        ),
        (OpenCv, xml.replace("distortion_coefficients", "coefficients"), "expected the key distortion_coefficients or"),
        (
            OpenCv,
            xml.replace("</nframes>", "</nframes><distortion_model>fov</distortion_model>"),
            "the model \"fov\" is not supported",
        ),
        (
            OpenCv,
            xml.replace("</nframes>", "</nframes><model>double_sphere</model>"),
            "the model \"double_sphere\" is not supported",
        ),
        (OpenCv, xml.replace("<cols>3</cols>", "<cols>2</cols>"), "expected rows × cols = 3 × 2"),
        (OpenCv, xml.replace("<image_height>480</image_height>", ""), "expected the key image_height"),
        (OpenCv, text_of("intrinsics.yml"), "contains the cameras M1, M2; select one by its name"),
        (
            OpenCv,
            text_of("intrinsics.yml").replace("D2:", "E2:").replace("M1:", "N1:"),
            "expected the key distortion_coefficients or distCoeffs or dist_coeffs or D of camera \"M2\"",
        ),
        (
            OpenCvFisheye,
            xml.replace("</nframes>", "</nframes><camera_model>pinhole</camera_model>"),
            "another model than a fisheye",
        ),
        (
            Ros,
            ros.replace("plumb_bob", "mei"),
            "unknown distortion model mei; expected one of plumb_bob, rational_polynomial, equidistant, fisheye, thin_prism, none",
        ),
        (Ros, ros.replace("plumb_bob", "thin_prism"), "found 5 numbers; thin_prism has 12 or 14"),
        (Ros, ros.replace("plumb_bob", "none"), "has no coefficients"),
        (
            Ros,
            ros.replace("[402.5, 0.0, 318.3, 0.0, 401.9, 241.7, 0.0, 0.0, 1.0]", "[0, 0, 0, 0, 0, 0, 0, 0, 0]"),
            "not calibrated",
        ),
        (Ros, ros.replace("[402.5, 0.0, 318.3", "[402.5, 0.1, 318.3"), "has a skew"),
        (Ros, format!("{ros}camera_model: equidistant\n"), "contradicts distortion_model \"plumb_bob\""),
        (Ros, text_of("ost.txt").replace("[narrow_stereo]", ""), "contains no camera"),
        (Kalibr, chain.replace("camera_model: omni", "camera_model: sphere"), "unknown camera model \"sphere\""),
        (
            Kalibr,
            chain.replace("distortion_model: equidistant", "distortion_model: plumb"),
            "the distortion model \"plumb\" is not supported",
        ),
        (Euroc, euroc.replace("sensor_type: camera", "sensor_type: imu"), "the sensor is of type \"imu\""),
        (Euroc, euroc.replace("radial-tangential", "rational"), "the distortion model \"rational\" is not supported"),
        (
            Camodocal,
            mei.replace("MEI", "FOV"),
            "unknown model type FOV; expected PINHOLE, PINHOLE_FULL, MEI, KANNALA_BRANDT or SCARAMUZZA",
        ),
        (Camodocal, mei.replace("p2:", "k3:"), "distortion_parameters contains k3"),
        (Camodocal, mei.replace("gamma1", "gamma0"), "projection_parameters contains gamma0"),
        (Camodocal, mei.replace("mirror_parameters", "mirrors"), "expected the key mirror_parameters"),
    ];
    let camera = |format, text: &str| match format {
        Kalibr if text.contains("sphere") => Some("cam2"),
        Kalibr => Some("cam0"),
        OpenCv if text.contains("E2:") => Some("M2"),
        _ => None,
    };
    let wrong = cases.into_iter().filter_map(|(format, text, expected)| {
        match read("a.txt", &text, format, camera(format, &text)) {
            Ok(_) => Some(format!("{format:?} is read: {expected}")),
            Err(message) => (!message.contains(expected)).then(|| format!("{message} (expected {expected})")),
        }
    });
    assert_eq!(wrong.collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn an_error_names_the_format_that_the_file_has() {
    use CalibrationFormat::{Camodocal, Colmap, Euroc, Kalibr, Ocam, OpenCv, Ros};
    let cases = [
        ("out_camera_data.xml", Kalibr, "opencv"),
        ("old_sample.yml", Ros, "opencv"),
        ("ros1_echo.yaml", Kalibr, "ros"),
        ("ost.txt", OpenCv, "ros"),
        ("ros_plumb_bob.yaml", Euroc, "ros"),
        ("camchain.yaml", Ros, "kalibr"),
        ("euroc_radtan.yaml", Camodocal, "euroc"),
        ("camodocal_mei.yaml", OpenCv, "camodocal"),
        ("camodocal_mei.yaml", Colmap, "camodocal"),
        ("camchain.yaml", Ocam, "kalibr"),
    ];
    for (name, stated, actual) in cases {
        let message = read_calibration(&stored(name), stated, None).expect_err(name).to_string();
        assert!(message.ends_with(&format!("; the file has the keys of the format \"{actual}\"")), "{name}: {message}");
    }
    let message = read_calibration(&stored("stereo.xml"), OpenCv, None).expect_err("two cameras").to_string();
    assert!(message.ends_with("select one by its name"), "{message}");
}

#[test]
fn a_broken_binary_of_colmap_is_refused() {
    let bytes = std::fs::read(stored("cameras.bin")).expect("bytes");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("cameras.bin");
    let message = |bytes: &[u8]| {
        std::fs::write(&file, bytes).expect("written");
        read_calibration(&file, CalibrationFormat::Colmap, Some("1")).expect_err("broken").to_string()
    };
    assert!(message(&bytes[..bytes.len() - 1]).contains("ends within a camera"));
    assert!(message(&[&bytes[..], &[0]].concat()).contains("1 bytes follow"));
    let mut other = bytes.clone();
    other[12] = 99;
    assert!(message(&other).contains("has the model number 99; expected 0 to 17"), "{}", message(&other));
    let huge = [&u64::MAX.to_le_bytes()[..], &bytes[8..]].concat();
    assert!(message(&huge).contains("ends within a camera"));
}
