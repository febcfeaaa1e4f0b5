//! nuScenes (Caesar et al. 2020): images in `nuscenes/samples/CAMERA`, and the tables of its schema in `nuscenes/v1.0-SPLIT`, which the nuScenes devkit reads.
//!
//! | table | is |
//! | --- | --- |
//! | `scene` | a sample of the set; its changes are the description |
//! | `sample` | a frame, of all cameras |
//! | `sample_data` | an image; all are key frames |
//! | `ego_pose`, `calibrated_sensor` | the frame that carries the camera in the world, and the camera in it; a camera without such a frame, or moving in it, is its own vehicle |
//! | `instance`, `sample_annotation` | objects that have a class and a visible pixel in some camera of the frame: their boxes in the world, with the best visibility of all cameras |
//! | `category` | the scene's classes |
//!
//! Times are µs from the beginning of the simulated world. Not written: lidar and radar (`num_lidar_pts` and `num_radar_pts` are 0), attributes, velocities
//! (except those that follow from positions), and maps: `map` names an image of one pixel, as readers require one.

use std::collections::BTreeMap;
use std::io::{self, Write};

use etendue::{Error, OutputFolder};
use etendue_io::png::encode_grey8;
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

use crate::record::{ImageRecord, ObjectRecord, Pose, SampleRecord};
use crate::records::{FormatWriter, Records, write};
use crate::{draw::Split, picture::SampleImage, set::Set};

pub(super) struct NuScenes;

/// Rows of a table from a sample.
type TableRowsFn = fn(&Set, &SampleRecord) -> Vec<Value>;

const TABLES: [(&str, TableRowsFn); 7] = [
    ("scene", scenes),
    ("sample", samples),
    ("sample_data", sample_data),
    ("ego_pose", ego_poses),
    ("calibrated_sensor", calibrated_sensors),
    ("instance", instances),
    ("sample_annotation", annotations),
];

impl FormatWriter for NuScenes {
    fn write_image(&self, _set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, _) = image.sample;
        write(folder, &format!("nuscenes/{}", file_name(sample, &image.record)), &image.bytes)
    }

    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        let no_map = encode_grey8(1, 1, &[0]).map_err(|error| Error::Run(error.to_string()))?;
        write(folder, "nuscenes/maps/none.png", &no_map)?;
        for split in Split::ALL {
            let table = |name: &str| format!("nuscenes/v1.0-{}/{name}.json", split.name());
            for (name, rows) in common_tables(set) {
                write(folder, &table(name), format!("{rows}\n").as_bytes())?;
            }
            for (name, rows_of) in TABLES {
                let written =
                    |file: &mut std::io::BufWriter<std::fs::File>| write_rows(set, records, split, rows_of, file);
                folder.write_with(&table(name), written).map_err(Error::run)?;
            }
        }
        Ok(())
    }
}

fn write_rows(
    set: &Set,
    records: &Records,
    split: Split,
    rows_of: TableRowsFn,
    file: &mut impl Write,
) -> io::Result<()> {
    file.write_all(b"[")?;
    let mut is_first = true;
    for record in records.each() {
        let record = record?;
        for row in
            Some(&record).filter(|record| record.split == split).map_or_else(Vec::new, |record| rows_of(set, record))
        {
            write!(file, "{}\n{row}", if is_first { "" } else { "," })?;
            is_first = false;
        }
    }
    file.write_all(b"]\n")
}

/// Kind of object that a token identifies: its first digits.
#[derive(Clone, Copy)]
enum TokenKind {
    Category = 1,
    Sensor,
    Log,
    Map,
    Scene,
    Sample,
    Data,
    Calibration,
    Instance,
    Annotation,
}

/// Token: 32 digits, unique in the set.
fn token(kind: TokenKind, numbers: [u32; 3]) -> String {
    let [a, b, c] = numbers;
    format!("{:08x}{a:08x}{b:08x}{c:08x}", kind as u32)
}

/// Tables that are the same for all samples.
fn common_tables(set: &Set) -> Vec<(&'static str, Value)> {
    let categories = set
        .classes
        .iter()
        .map(|(name, id)| json!({ "token": token(TokenKind::Category, [*id, 0, 0]), "name": name, "description": "" }));
    let levels = ["v0-40", "v40-60", "v60-80", "v80-100"].into_iter().zip(1..);
    let levels = levels.map(|(level, number)| {
        json!({ "token": number.to_string(), "level": level, "description": "part of the object in the picture that is seen, %" })
    });
    let sensors = set.cameras.iter().zip(0..).map(
        |(name, place)| json!({ "token": token(TokenKind::Sensor, [place, 0, 0]), "channel": name, "modality": "camera" }),
    );
    let log = token(TokenKind::Log, [0; 3]);
    let map = json!({
        "token": token(TokenKind::Map, [0; 3]), "log_tokens": [log], "category": "semantic_prior", "filename": "maps/none.png",
    });
    vec![
        ("category", categories.collect()),
        ("attribute", json!([])),
        ("visibility", levels.collect()),
        ("sensor", sensors.collect()),
        ("log", json!([{ "token": log, "logfile": "", "vehicle": "", "date_captured": "", "location": "" }])),
        ("map", json!([map])),
    ]
}

fn file_name(sample: u32, image: &ImageRecord) -> String {
    format!("samples/{}/{}.{}", image.camera, image.stem(sample), image.extension)
}

fn place(set: &Set, image: &ImageRecord) -> u32 {
    set.cameras.iter().position(|camera| *camera == image.camera).expect("a camera of the job") as u32
}

fn time_us(image: &ImageRecord) -> i64 {
    (image.exact_time().nanoseconds() + 500).div_euclid(1000) as i64
}

fn sample_token(record: &SampleRecord, frame: u32) -> String {
    token(TokenKind::Sample, [record.sample, frame, 0])
}

fn data_token(set: &Set, record: &SampleRecord, image: &ImageRecord) -> String {
    token(TokenKind::Data, [record.sample, image.frame, place(set, image)])
}

/// Token of the previous or next element of a list; empty at its end.
fn neighbour(frames: &[u32], at: Option<usize>, token: impl Fn(u32) -> String) -> String {
    at.and_then(|at| frames.get(at)).map_or_else(String::new, |frame| token(*frame))
}

fn scenes(set: &Set, record: &SampleRecord) -> Vec<Value> {
    vec![json!({
        "token": token(TokenKind::Scene, [record.sample, 0, 0]),
        "name": format!("scene-{:06}", record.sample),
        "description": record.set.join("; "),
        "log_token": token(TokenKind::Log, [0; 3]),
        "nbr_samples": set.frame_count(),
        "first_sample_token": sample_token(record, set.frames.start),
        "last_sample_token": sample_token(record, set.frames.end - 1),
    })]
}

fn samples(set: &Set, record: &SampleRecord) -> Vec<Value> {
    let frames: Vec<u32> = set.frames.clone().collect();
    let row = |(at, frame): (usize, &u32)| {
        let first = record.pictures.iter().find(|image| image.frame == *frame);
        json!({
            "token": sample_token(record, *frame),
            "timestamp": first.map_or(0, time_us),
            "prev": neighbour(&frames, at.checked_sub(1), |frame| sample_token(record, frame)),
            "next": neighbour(&frames, at.checked_add(1), |frame| sample_token(record, frame)),
            "scene_token": token(TokenKind::Scene, [record.sample, 0, 0]),
        })
    };
    frames.iter().enumerate().map(row).collect()
}

fn sample_data(set: &Set, record: &SampleRecord) -> Vec<Value> {
    let frames: Vec<u32> = set.frames.clone().collect();
    let row = |image: &ImageRecord| {
        let (of_camera, at) = (place(set, image), (image.frame - set.frames.start) as usize);
        let token_at = |frame| token(TokenKind::Data, [record.sample, frame, of_camera]);
        json!({
            "token": token_at(image.frame),
            "sample_token": sample_token(record, image.frame),
            "ego_pose_token": token_at(image.frame),
            "calibrated_sensor_token": token(TokenKind::Calibration, [record.sample, of_camera, 0]),
            "timestamp": time_us(image),
            "fileformat": image.extension,
            "is_key_frame": true,
            "height": image.height_px,
            "width": image.width_px,
            "filename": file_name(record.sample, image),
            "prev": neighbour(&frames, at.checked_sub(1), token_at),
            "next": neighbour(&frames, at.checked_add(1), token_at),
        })
    };
    record.pictures.iter().map(row).collect()
}

fn ego_poses(set: &Set, record: &SampleRecord) -> Vec<Value> {
    let row = |image: &ImageRecord| {
        let (place_m, rotation) = parts(&image.pose);
        // Pose of the carrying frame: the inverse of camera-to-frame, then camera-to-world.
        let (place_m, rotation) = image.mount.as_ref().map(parts).map_or((place_m, rotation), |(mount_m, mount)| {
            let rotation = rotation * mount.inverse();
            (place_m - rotation * mount_m, rotation)
        });
        json!({
            "token": data_token(set, record, image),
            "timestamp": time_us(image),
            "translation": place_m.to_array(),
            "rotation": wxyz(rotation),
        })
    };
    record.pictures.iter().map(row).collect()
}

fn calibrated_sensors(set: &Set, record: &SampleRecord) -> Vec<Value> {
    let first = record.pictures.iter().filter(|image| image.frame == set.frames.start);
    let row = |image: &ImageRecord| {
        let [fx, skew, cx, fy, cy] = image.camera_matrix_px.expect("checked for all cameras of the format");
        let (place_m, rotation) = image.mount.as_ref().map_or((DVec3::ZERO, DQuat::IDENTITY), parts);
        let of_camera = place(set, image);
        json!({
            "token": token(TokenKind::Calibration, [record.sample, of_camera, 0]),
            "sensor_token": token(TokenKind::Sensor, [of_camera, 0, 0]),
            "translation": place_m.to_array(),
            "rotation": wxyz(rotation),
            "camera_intrinsic": [[fx, skew, cx - 0.5], [0.0, fy, cy - 0.5], [0.0, 0.0, 1.0]],
        })
    };
    first.map(row).collect()
}

fn parts(pose: &Pose) -> (DVec3, DQuat) {
    let [w, x, y, z] = pose.rotation_wxyz;
    (DVec3::from_array(pose.position_m), DQuat::from_xyzw(x, y, z, w))
}

fn wxyz(rotation: DQuat) -> [f64; 4] {
    let [x, y, z, w] = rotation.to_array();
    [w, x, y, z]
}

/// Object in a frame: record of the first camera that sees it, and the best visibility.
struct ObservedObject<'a> {
    object: &'a ObjectRecord,
    class: u32,
    visible_fraction: f64,
}

/// Frames in which each object is visible.
fn observed_objects<'a>(set: &Set, record: &'a SampleRecord) -> BTreeMap<u32, BTreeMap<u32, ObservedObject<'a>>> {
    let mut observed: BTreeMap<u32, BTreeMap<u32, ObservedObject<'_>>> = BTreeMap::new();
    for image in &record.pictures {
        for (object, _, _) in image.visible() {
            let Some(class) = set.class_id(object.class.as_deref()) else { continue };
            let visible_fraction = object.visible_fraction;
            let frames = observed.entry(object.id).or_default();
            let known = frames.entry(image.frame).or_insert(ObservedObject { object, class, visible_fraction });
            known.visible_fraction = known.visible_fraction.max(visible_fraction);
        }
    }
    observed
}

fn annotation_token(record: &SampleRecord, id: u32, frame: u32) -> String {
    token(TokenKind::Annotation, [record.sample, id, frame])
}

fn instances(set: &Set, record: &SampleRecord) -> Vec<Value> {
    let row = |(id, frames): (u32, BTreeMap<u32, ObservedObject<'_>>)| {
        let ((first, observed), (last, _)) = (frames.first_key_value()?, frames.last_key_value()?);
        Some(json!({
            "token": token(TokenKind::Instance, [record.sample, id, 0]),
            "category_token": token(TokenKind::Category, [observed.class, 0, 0]),
            "nbr_annotations": frames.len(),
            "first_annotation_token": annotation_token(record, id, *first),
            "last_annotation_token": annotation_token(record, id, *last),
        }))
    };
    observed_objects(set, record).into_iter().filter_map(row).collect()
}

fn annotations(set: &Set, record: &SampleRecord) -> Vec<Value> {
    let mut rows = Vec::new();
    for (id, observed) in observed_objects(set, record) {
        let frames: Vec<u32> = observed.keys().copied().collect();
        for (at, (frame, ObservedObject { object, visible_fraction, .. })) in observed.iter().enumerate() {
            let [x, y, z] = object.box_3d.size_m;
            rows.push(json!({
                "token": annotation_token(record, id, *frame),
                "sample_token": sample_token(record, *frame),
                "instance_token": token(TokenKind::Instance, [record.sample, id, 0]),
                "visibility_token": visibility(*visible_fraction),
                "attribute_tokens": [],
                "translation": object.box_3d.world.centre_m,
                "size": [y, x, z],
                "rotation": object.box_3d.world.rotation_wxyz,
                "prev": neighbour(&frames, at.checked_sub(1), |frame| annotation_token(record, id, frame)),
                "next": neighbour(&frames, at.checked_add(1), |frame| annotation_token(record, id, frame)),
                "num_lidar_pts": 0,
                "num_radar_pts": 0,
            }));
        }
    }
    rows
}

/// Row of `visibility`.
fn visibility(fraction: f64) -> &'static str {
    match fraction {
        less if less < 0.4 => "1",
        less if less < 0.6 => "2",
        less if less < 0.8 => "3",
        _ => "4",
    }
}
