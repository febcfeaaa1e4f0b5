//! Calibration files of a rig, read by independent formulas and compared with the program's projection.

use etendue::{ExistingFiles, Job, NullObserver};
use etendue_core::maths::f64::{atan2, cos, sin};
use glam::{DMat3, DVec2, DVec3};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Coordinates of some thousand m and px in f64: the world's rounding of 1e-12 m is 1e-10 px.
const TOLERANCE_PX: f64 = 1e-6;

/// Pose of the car at 0 s: position, m, and yaw, degrees.
const CAR_M: [f64; 3] = [1000.0, -2000.0, 3.0];
const CAR_YAW_DEG: f64 = 30.0;

fn figures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures")
}

fn job() -> Job {
    Job::open(figures().join("rig/rig.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn written(job: &Job, folder: &Path) -> impl Fn(&str) -> String {
    job.save_calibration_files(&(0..3), folder, ExistingFiles::Refuse, &NullObserver).expect("written");
    let root = folder.join("calibration");
    move |name| std::fs::read_to_string(root.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Points of the world in front of a camera at 0 s, by its own axes.
fn points(job: &Job, name: &str) -> Vec<DVec3> {
    let pose = job.plan().camera(name).expect("a camera").path.at(0.0);
    let places = [[0.0, 0.0, 5.0], [1.2, -0.8, 4.0], [-1.5, 0.9, 6.0], [2.0, 1.5, 9.0], [-0.3, -1.1, 3.0]];
    places.into_iter().map(|place| pose.position_m + pose.rotation * DVec3::from_array(place)).collect()
}

/// Reference: the program's image of a point of the world, raster px.
fn truth(job: &Job, name: &str, time_s: f64, point_m: DVec3) -> DVec2 {
    let camera = job.plan().camera(name).expect("a camera");
    let image_mm = camera.body.lens.project(camera.path.at(time_s).point_to_camera(point_m)).expect("in the field");
    camera.body.raster.raster_px(image_mm)
}

/// The numbers of the first list after a word.
fn list(text: &str, word: &str) -> Vec<f64> {
    let rest = &text[text.find(word).unwrap_or_else(|| panic!("{word} in {text}"))..];
    let inside = &rest[rest.find('[').expect("a list") + 1..rest.find(']').expect("its end")];
    inside
        .split(',')
        .filter(|word| !word.trim().is_empty())
        .map(|word| word.trim().parse().expect("a number"))
        .collect()
}

/// OpenCV's image of a point of the camera frame, with a matrix whose pixel centres are at whole numbers.
fn opencv_image_px([fx, fy, cx, cy]: [f64; 4], model: &str, k: &[f64], point: DVec3) -> DVec2 {
    let at = |i: usize| k.get(i).copied().unwrap_or(0.0);
    let (x, y) = (point.x / point.z, point.y / point.z);
    let s = x * x + y * y;
    let (x, y) = match model {
        "plumb_bob" | "radtan" | "OPENCV" | "FULL_OPENCV" | "PINHOLE" => {
            let radial = (1.0 + at(0) * s + at(1) * s * s + at(4) * s * s * s)
                / (1.0 + at(5) * s + at(6) * s * s + at(7) * s * s * s);
            (
                x * radial + 2.0 * at(2) * x * y + at(3) * (s + 2.0 * x * x),
                y * radial + at(2) * (s + 2.0 * y * y) + 2.0 * at(3) * x * y,
            )
        }
        "equidistant" | "OPENCV_FISHEYE" => {
            let r = (point.x * point.x + point.y * point.y).sqrt();
            let angle = atan2(r, point.z);
            let t = angle * angle;
            let bent = angle * (1.0 + t * (at(0) + t * (at(1) + t * (at(2) + t * at(3)))));
            let scale = if r > 0.0 { bent / r } else { 0.0 };
            (point.x * scale, point.y * scale)
        }
        other => panic!("{other}"),
    };
    DVec2::new(fx * x + cx, fy * y + cy)
}

fn word<'a>(text: &'a str, key: &str) -> &'a str {
    let rest = &text[text.find(key).unwrap_or_else(|| panic!("{key} in {text}")) + key.len()..];
    rest.lines().next().expect("a line").trim()
}

/// The rotation of a quaternion w, x, y, z.
fn rotation([w, x, y, z]: [f64; 4]) -> DMat3 {
    DMat3::from_cols_array(&[
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y + w * z),
        2.0 * (x * z - w * y),
        2.0 * (x * y - w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z + w * x),
        2.0 * (x * z + w * y),
        2.0 * (y * z - w * x),
        1.0 - 2.0 * (x * x + y * y),
    ])
}

#[track_caller]
fn assert_near(actual: DVec2, expected: DVec2, what: &str) {
    assert!((actual - expected).length() < TOLERANCE_PX, "{what}: {actual} for {expected}");
}

/// Transforms a point from the car's frame to the camera's, by `static_transforms.yaml`: the inverse of its rotation and translation.
fn into_camera(transforms: &str, name: &str, point_m: DVec3) -> DVec3 {
    let entry = &transforms[transforms.find(&format!("\"{name}_optical_frame\"")).expect("the camera")..];
    let number = |part: &str, key: &str| -> f64 {
        let line = &entry[entry.find(part).expect("a part")..];
        let rest = &line[line.find(&format!("{key}: ")).expect("a key") + key.len() + 2..];
        rest[..rest.find([',', '}']).expect("an end")].parse().expect("a number")
    };
    let place = DVec3::from_array(["x", "y", "z"].map(|key| number("translation", key)));
    let turn = rotation(["w", "x", "y", "z"].map(|key| number("rotation", key)));
    turn.transpose() * (point_m - place)
}

/// Transforms a point of the world to the car's frame at 0 s.
fn to_car_frame(point_m: DVec3) -> DVec3 {
    let (sin, cos) = (sin(CAR_YAW_DEG.to_radians()), cos(CAR_YAW_DEG.to_radians()));
    let [x, y, z] = (point_m - DVec3::from_array(CAR_M)).to_array();
    DVec3::new(cos * x + sin * y, cos * y - sin * x, z)
}

#[test]
fn camera_info_and_fixed_transforms_see_what_the_program_sees() {
    let (job, folder) = (job(), tempfile::tempdir().expect("a folder"));
    let read = written(&job, folder.path());
    let transforms = read("ros/static_transforms.yaml");
    for (name, model) in [
        ("left", "plumb_bob"),
        ("right", "plumb_bob"),
        ("side", "plumb_bob"),
        ("five", "plumb_bob"),
        ("rear", "equidistant"),
    ] {
        let info = read(&format!("ros/{name}.yaml"));
        assert_eq!(word(&info, "distortion_model: "), model, "{name}");
        let (k, d) = (list(&info, "camera_matrix"), list(&info, "distortion_coefficients"));
        for point in points(&job, name) {
            let actual = opencv_image_px(
                [k[0], k[4], k[2], k[5]],
                model,
                &d,
                into_camera(&transforms, name, to_car_frame(point)),
            );
            assert_near(actual + 0.5, truth(&job, name, 0.0, point), name);
        }
    }
    assert!(transforms.contains("# left out: camera walker: it moves in \"world\""), "{transforms}");
    assert!(transforms.contains("frame_id: \"car\""), "{transforms}");
}

/// u of the right camera is that of (P X)₀/(P X)₂ with P[3] = −f b, X in the left camera's frame.
#[test]
fn the_projection_matrix_of_a_pair_holds_its_base() {
    let (job, folder) = (job(), tempfile::tempdir().expect("a folder"));
    let read = written(&job, folder.path());
    let (left, right) =
        (list(&read("ros/left.yaml"), "projection_matrix"), list(&read("ros/right.yaml"), "projection_matrix"));
    assert_eq!(left[3], 0.0);
    assert!((right[3] + right[0] * 0.3).abs() < 1e-9, "{right:?}");
    let pose = job.plan().camera("left").expect("a camera").path.at(0.0);
    for point in points(&job, "left") {
        let x = pose.point_to_camera(point);
        let actual = DVec2::new(
            (right[0] * x.x + right[2] * x.z + right[3]) / x.z,
            (right[5] * x.y + right[6] * x.z + right[7]) / x.z,
        );
        assert_near(actual + 0.5, truth(&job, "right", 0.0, point), "right");
    }
}

/// Points are transformed from camera to camera by T_cn_cnm1, and from the car by T_cam_imu.
#[test]
fn a_chain_takes_points_from_camera_to_camera() {
    let (job, folder) = (job(), tempfile::tempdir().expect("a folder"));
    let read = written(&job, folder.path());
    let chain = read("kalibr/camchain-left.yaml");
    let cameras: Vec<&str> = chain.split("cam").skip(1).filter(|part| part.contains("intrinsics:")).collect();
    let blocks: Vec<&str> = chain.split("\ncam").skip(1).collect();
    assert_eq!(blocks.len(), 4, "{cameras:?}");
    let matrix = |block: &str, key: &str| -> [[f64; 4]; 3] {
        let rest = &block[block.find(key).expect("a matrix") + key.len()..];
        let rows: Vec<Vec<f64>> = rest.lines().skip(1).take(3).map(|line| list(line, "-")).collect();
        std::array::from_fn(|i| std::array::from_fn(|j| rows[i][j]))
    };
    let apply = |m: &[[f64; 4]; 3], p: DVec3| {
        DVec3::from_array(std::array::from_fn(|i| m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3]))
    };
    for (i, (block, name)) in blocks.iter().zip(["left", "right", "side", "rear"]).enumerate() {
        assert_eq!(word(block, "rostopic: "), format!("/{name}/image_raw"));
        let (k, d) = (list(block, "intrinsics"), list(block, "distortion_coeffs"));
        let model = word(block, "distortion_model: ");
        for point in points(&job, name) {
            let from_car = apply(&matrix(block, "T_cam_imu:"), to_car_frame(point));
            let expected = truth(&job, name, 0.0, point);
            assert_near(opencv_image_px([k[0], k[1], k[2], k[3]], model, &d, from_car) + 0.5, expected, name);
            if let Some(before) = i.checked_sub(1) {
                let there = apply(&matrix(blocks[before], "T_cam_imu:"), to_car_frame(point));
                let here = apply(&matrix(block, "T_cn_cnm1:"), there);
                assert_near(opencv_image_px([k[0], k[1], k[2], k[3]], model, &d, here) + 0.5, expected, name);
            }
        }
    }
    // Five coefficients are one too many; a camera that moves in the world is rigidly connected to nothing.
    assert!(chain.contains("# left out: camera five: Kalibr has no perspective model with this number of"), "{chain}");
    assert!(chain.contains("camera globe: Kalibr has no model for its projection"), "{chain}");
    assert!(!folder.path().join("calibration/kalibr/camchain-walker.yaml").exists());
}

/// Every image's pose and its camera's parameters; the car moves from frame to frame, and so does the walker.
#[test]
fn colmap_s_model_sees_what_the_program_sees_in_every_frame() {
    let (job, folder) = (job(), tempfile::tempdir().expect("a folder"));
    let read = written(&job, folder.path());
    let (cameras, images) = (read("colmap/cameras.txt"), read("colmap/images.txt"));
    let lines = |text: &str| -> Vec<Vec<String>> {
        let data_lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        data_lines.map(|line| line.split(' ').map(str::to_owned).collect()).collect()
    };
    let (cameras, images) = (lines(&cameras), lines(&images));
    let models: Vec<&str> = cameras.iter().map(|line| line[1].as_str()).collect();
    assert_eq!(models, ["PINHOLE", "PINHOLE", "OPENCV", "FULL_OPENCV", "OPENCV_FISHEYE", "PINHOLE"]);
    assert_eq!(images.len(), 18);
    for (i, image) in images.iter().enumerate() {
        let numbers: Vec<f64> = image[1..8].iter().map(|word| word.parse().expect("a number")).collect();
        let camera = &cameras[image[8].parse::<usize>().expect("an id") - 1];
        let parameters: Vec<f64> = camera[4..].iter().map(|word| word.parse().expect("a number")).collect();
        let name = ["left", "right", "side", "five", "rear", "walker"][i / 3];
        let frame = i % 3;
        assert_eq!(image[9], format!("{name}/picture.{frame:04}.png"));
        assert!(numbers[0] >= 0.0, "w of the quaternion");
        let turn = rotation([numbers[0], numbers[1], numbers[2], numbers[3]]);
        let shift = DVec3::new(numbers[4], numbers[5], numbers[6]);
        // OpenCV has k3 after the tangential terms.
        let [fx, fy, cx, cy, ref k @ ..] = parameters[..] else { panic!("{parameters:?}") };
        for point in points(&job, name) {
            let expected = truth(&job, name, 0.1 * frame as f64, point);
            assert_near(opencv_image_px([fx, fy, cx, cy], &camera[1], k, turn * point + shift), expected, name);
        }
    }
    assert!(read("colmap/points3D.txt").starts_with('#'));
}

/// Points of a table with their pixels.
fn table(value: &Value) -> Vec<(DVec3, DVec2)> {
    let numbers = |value: &Value| -> Vec<f64> {
        value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    let list = |key: &str| value[key].as_array().expect("a list").clone();
    let pairs = list("points_m").into_iter().zip(list("pixels"));
    pairs.map(|(p, px)| (DVec3::from_slice(&numbers(&p)), DVec2::from_slice(&numbers(&px)))).collect()
}

/// Transforms a point of the car's frame at 0 s to the world.
fn car_to_world(point_m: DVec3) -> DVec3 {
    let (sin, cos) = (sin(CAR_YAW_DEG.to_radians()), cos(CAR_YAW_DEG.to_radians()));
    DVec3::new(cos * point_m.x - sin * point_m.y, sin * point_m.x + cos * point_m.y, point_m.z)
        + DVec3::from_array(CAR_M)
}

/// PyYAML, OpenCV and COLMAP on the stored files (tests/oracles/rig.py).
#[test]
fn other_programs_that_read_the_files_see_what_the_program_sees() {
    let job = job();
    let text = std::fs::read_to_string(figures().join("rig.json")).expect("figures");
    let figures: Value = serde_json::from_str(&text).expect("JSON");
    for name in ["left", "right", "side", "five", "rear"] {
        assert_eq!(figures["ros"][name]["frame"], "car");
        for (point, px) in table(&figures["ros"][name]) {
            assert_near(px, truth(&job, name, 0.0, car_to_world(point)), name);
        }
    }
    let left = job.plan().camera("left").expect("a camera").path.at(0.0);
    for (point, px) in table(&figures["ros"]["pair"]) {
        assert_near(px, truth(&job, "right", 0.0, left.position_m + left.rotation * point), "pair");
    }
    for name in ["left", "right", "side", "rear"] {
        for (point, px) in table(&figures["kalibr"][name]) {
            assert_near(px, truth(&job, name, 0.0, car_to_world(point)), name);
        }
    }
    let images = figures["colmap"].as_array().expect("a list");
    assert_eq!(images.len(), 18);
    for image in images {
        let file = image["name"].as_str().expect("a name");
        let (name, file_name) = file.split_once('/').expect("a folder");
        let frame: f64 = file_name.split('.').nth(1).and_then(|number| number.parse().ok()).expect("a number");
        for (point, px) in table(image) {
            assert_near(px, truth(&job, name, 0.1 * frame, point), file);
        }
    }
}

#[test]
fn the_files_that_they_read_are_those_that_the_program_writes() {
    let (job, folder) = (job(), tempfile::tempdir().expect("a folder"));
    let written =
        job.save_calibration_files(&(0..3), folder.path(), ExistingFiles::Refuse, &NullObserver).expect("written");
    assert_eq!(written.len(), 11);
    for path in written {
        let name = path.strip_prefix(folder.path()).expect("within");
        let stored = std::fs::read_to_string(figures().join("rig").join(name)).expect("a stored file");
        assert_eq!(std::fs::read_to_string(&path).expect("a file"), stored, "{}", name.display());
    }
}
