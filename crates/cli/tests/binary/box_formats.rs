//! One cuboid, modelled with various axes and rotated, in every data-set format with 3D boxes: size and heading by each format's published
//! convention. MCAP is not included, as its messages contain no boxes.
//!
//! | format | size | heading | source |
//! | --- | --- | --- | --- |
//! | boxes, tracks | x forward, y left, z up | quaternion w, x, y, z of the object's axes in the world | `conventions` in the file |
//! | nuScenes | `size`: width, length, height | `rotation`: quaternion w, x, y, z in the world, x forward | the devkit's `schema_nuscenes.md`, `Box` of `data_classes.py` |
//! | OpenLABEL | last three of `val`: sx forward, sy left, sz up | qx, qy, qz, qw before them | ASAM OpenLABEL 1.0.0, cuboid |
//! | OSI | `dimension`: length, width, height | `orientation`: roll, pitch, yaw about x, y, z (ISO 8855) | `osi_common.proto` 3.8.0 |
//! | BOP | `models_info.json`: size along the model's axes, mm | `cam_R_m2c`, row by row, and `cam_t_m2c`, mm: model to camera (OpenCV's axes) | bop_toolkit, page bop_datasets_format |
//! | KITTI | height, width, length | `rotation_y` about the camera's y, 0 where x forward is the camera's x | readme.txt of the object development kit |

use crate::object_axes::{AXES, SIZE_M, assert_near, job, label, numbers, obj};
use crate::support::{etendue, text};
use etendue_core::maths::f64::sin_cos;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

/// Centre of the car at (10, 2, 0) m.
const CENTRE_M: [f64; 3] = [10.0, 2.0, 0.65];
/// Rotations of the object about the vertical, degrees.
const TURNS_DEG: [f64; 4] = [0.0, 40.0, -90.0, 170.0];

/// A data set and a rendering of the car.
struct ExportedBoxes {
    folder: tempfile::TempDir,
    turn_deg: f64,
    case: String,
}

impl ExportedBoxes {
    fn new(forward: &str, up: &str, turn_deg: f64) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("car.obj"), obj(forward, up)).expect("written");
        let job = job(forward, up, turn_deg).replace("boxes = true", "boxes = true\ntracks = true");
        fs::write(folder.path().join("job.toml"), job).expect("written");
        let at = |name: &str| text(&folder.path().join(name));
        let formats =
            ["kitti", "nuscenes", "openlabel", "osi", "bop"].into_iter().flat_map(|format| ["--format", format]);
        let set = ["dataset", &at("job.toml"), "-o", &at("set"), "--samples", "0..1"].map(str::to_owned);
        etendue(set.into_iter().chain(formats.map(str::to_owned))).ok();
        etendue(["render", &at("job.toml"), "-o", &at("out")]).ok();
        Self { folder, turn_deg, case: format!("forward {forward}, up {up}, turned by {turn_deg}°") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn json(&self, name: &str) -> Value {
        let bytes = fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        serde_json::from_slice(&bytes).expect("JSON")
    }

    fn assert(&self, format: &str, actual: &[f64], expected: &[f64]) {
        assert_near(actual, expected, &format!("{format}, {}", self.case));
    }

    /// Returns sine and cosine of half the rotation angle.
    fn half_turn(&self) -> (f64, f64) {
        sin_cos(self.turn_deg.to_radians() / 2.0)
    }
}

/// Of the two quaternions of a rotation, returns the one whose component at `w` is above 0.
fn positive(mut quaternion: Vec<f64>, w: usize) -> Vec<f64> {
    if quaternion[w] < 0.0 {
        quaternion.iter_mut().for_each(|number| *number = -*number);
    }
    quaternion
}

#[test]
fn every_format_has_the_size_and_the_heading_of_its_convention() {
    for (forward, up) in AXES {
        for turn_deg in TURNS_DEG {
            let export = ExportedBoxes::new(forward, up, turn_deg);
            check_kitti(&export);
            check_own(&export);
            check_nuscenes(&export);
            check_openlabel(&export);
            check_osi(&export);
            check_bop(&export);
        }
    }
}

fn check_kitti(export: &ExportedBoxes) {
    let label_row = label(&export.path("set"));
    export.assert("KITTI", &label_row[7..10], &[SIZE_M.z, SIZE_M.y, SIZE_M.x]);
    // Modulo 360°: −90° minus the rotation about z, as y points down.
    let (heading, expected) = (sin_cos(label_row[13]), sin_cos((-90.0 - export.turn_deg).to_radians()));
    export.assert("KITTI", &[heading.0, heading.1], &[expected.0, expected.1]);
}

fn check_own(export: &ExportedBoxes) {
    let (sin, cos) = export.half_turn();
    let (boxes, tracks) = (export.json("out/front/boxes.json"), export.json("out/front/tracks.json"));
    for (name, object) in [("boxes", &boxes["objects"][0]), ("tracks", &tracks["tracks"][0]["frames"][0])] {
        let solid = &object["box_3d"];
        export.assert(name, &numbers(&solid["size_m"]), &SIZE_M.to_array());
        export.assert(name, &numbers(&solid["world"]["centre_m"]), &CENTRE_M);
        export.assert(name, &positive(numbers(&solid["world"]["rotation_wxyz"]), 0), &[cos, 0.0, 0.0, sin]);
    }
}

fn check_nuscenes(export: &ExportedBoxes) {
    let (sin, cos) = export.half_turn();
    let annotation = &export.json("set/nuscenes/v1.0-train/sample_annotation.json")[0];
    export.assert("nuScenes", &numbers(&annotation["size"]), &[SIZE_M.y, SIZE_M.x, SIZE_M.z]);
    export.assert("nuScenes", &numbers(&annotation["translation"]), &CENTRE_M);
    export.assert("nuScenes", &positive(numbers(&annotation["rotation"]), 0), &[cos, 0.0, 0.0, sin]);
}

fn check_openlabel(export: &ExportedBoxes) {
    let (sin, cos) = export.half_turn();
    let content = export.json("set/openlabel/train/000000.json");
    let objects = content["openlabel"]["frames"]["0"]["objects"].as_object().expect("objects").clone();
    let (_, object) = objects.iter().next().expect("the car");
    let cuboid = numbers(&object["object_data"]["cuboid"][0]["val"]);
    export.assert("OpenLABEL", &cuboid[..3], &CENTRE_M);
    export.assert("OpenLABEL", &positive(cuboid[3..7].to_vec(), 3), &[0.0, 0.0, sin, cos]);
    export.assert("OpenLABEL", &cuboid[7..], &SIZE_M.to_array());
}

/// `GroundTruth.moving_object` (5), `MovingObject.base` (2), `BaseMoving`: dimension (1), position (2), orientation (3).
fn check_osi(export: &ExportedBoxes) {
    let folder = export.path("set/osi/train");
    let file = fs::read_dir(&folder).expect("a folder").next().expect("a trace").expect("a trace").path();
    let trace = fs::read(file).expect("a trace");
    let length = u32::from_le_bytes(trace[..4].try_into().expect("four bytes")) as usize;
    assert_eq!(trace.len(), 4 + length, "one frame");
    let base = field(field(&trace[4..], 5), 2);
    let vector = |number: u64| numbers_of(field(base, number));
    export.assert("OSI", &vector(1), &SIZE_M.to_array());
    export.assert("OSI", &vector(2), &CENTRE_M);
    export.assert("OSI", &vector(3), &[0.0, 0.0, export.turn_deg.to_radians()]);
}

/// The object's x is (−sin, 0, cos) in the camera's axes. The camera looks along the world's x: its x is the world's −y, its y the world's −z, its z
/// the world's x.
fn check_bop(export: &ExportedBoxes) {
    let (sin, cos) = sin_cos(export.turn_deg.to_radians());
    let poses = export.json("set/bop/train/000000/scene_gt.json");
    let pose = &poses["0"][0];
    export.assert("BOP", &numbers(&pose["cam_R_m2c"]), &[-sin, -cos, 0.0, 0.0, 0.0, -1.0, cos, -sin, 0.0]);
    // The camera is 1.5 m above the ground.
    let translation_m: Vec<f64> = numbers(&pose["cam_t_m2c"]).iter().map(|mm| mm / 1000.0).collect();
    export.assert("BOP", &translation_m, &[-CENTRE_M[1], 1.5 - CENTRE_M[2], CENTRE_M[0]]);
    let models = export.json("set/bop/models/models_info.json");
    let model = &models[pose["obj_id"].to_string()];
    let metres = |keys: [&str; 3]| keys.map(|key| model[key].as_f64().expect("a number") / 1000.0);
    export.assert("BOP", &metres(["size_x", "size_y", "size_z"]), &SIZE_M.to_array());
    export.assert("BOP", &metres(["min_x", "min_y", "min_z"]), &(-0.5 * SIZE_M).to_array());
}

/// Returns the bytes of the first length-delimited field with the number `wanted` in a protobuf message.
fn field(mut message: &[u8], number: u64) -> &[u8] {
    while !message.is_empty() {
        let key = varint(&mut message);
        let length = match key & 7 {
            0 => {
                varint(&mut message);
                0
            }
            1 => 8,
            _ => varint(&mut message) as usize,
        };
        let (content, rest) = message.split_at(length);
        if key == number << 3 | 2 {
            return content;
        }
        message = rest;
    }
    panic!("no field {number}")
}

fn varint(bytes: &mut &[u8]) -> u64 {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (byte, rest) = bytes.split_first().expect("a byte");
        *bytes = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            break;
        }
    }
    value
}

/// Reads three doubles, fields 1, 2 and 3.
fn numbers_of(message: &[u8]) -> Vec<f64> {
    assert_eq!((message.len(), message[0], message[9], message[18]), (27, 1 << 3 | 1, 2 << 3 | 1, 3 << 3 | 1));
    [1, 10, 19].map(|at: usize| f64::from_le_bytes(message[at..at + 8].try_into().expect("a double"))).to_vec()
}
