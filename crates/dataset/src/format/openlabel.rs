//! ASAM OpenLABEL 1.0.0: `openlabel/SPLIT/NNNNNN.json`, one file per sample, and its images in `openlabel/SPLIT/images`.
//!
//! - A camera is a stream and a coordinate system of type `sensor_cs` (x right, y down, z forward), whose pose in `world` (`scene_cs`: x forward, y left, z up)
//!   each frame states. A camera that distorts has no intrinsic parameters.
//! - Objects are those with a class and a visible pixel in some image, by identity; `type` is the class.
//! - `bbox` bounds the visible pixels of the object: centre and size, px in raster coordinates, in the coordinate system of its camera; `cuboid` is the
//!   object's box in the world, centre, quaternion (x, y, z, w) and size, m. `num` is the visible fraction of the object.
//! - Not written: masks, relations, actions and events, ontologies.

use std::collections::{BTreeMap, BTreeSet};

use etendue::{Error, OutputFolder};
use glam::{DMat4, DQuat, DVec3};
use serde_json::{Map, Value, json};

use crate::record::{ImageRecord, ObjectRecord, Pose, SampleRecord};
use crate::records::{FormatWriter, Records, write};
use crate::{picture::SampleImage, set::Set};

pub(super) struct OpenLabel;

/// Coordinate system of the scene.
const WORLD: &str = "world";

impl FormatWriter for OpenLabel {
    fn write_image(&self, _set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, split) = image.sample;
        write(folder, &format!("openlabel/{}/{}", split.name(), uri(sample, &image.record)), &image.bytes)
    }

    fn sample(&self, set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        let text = format!("{}\n", json!({ "openlabel": content(set, record) }));
        write(folder, &format!("openlabel/{}/{:06}.json", record.split.name(), record.sample), text.as_bytes())
    }

    fn finish(&self, _set: &Set, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}

fn uri(sample: u32, image: &ImageRecord) -> String {
    format!("images/{}.{}", image.stem(sample), image.extension)
}

fn content(set: &Set, record: &SampleRecord) -> Value {
    let mut frames: BTreeMap<u32, Vec<&ImageRecord>> = BTreeMap::new();
    record.pictures.iter().for_each(|image| frames.entry(image.frame).or_default().push(image));
    let mut observed: BTreeMap<u32, (&ObjectRecord, BTreeSet<u32>)> = BTreeMap::new();
    for image in &record.pictures {
        for object in labelled(image) {
            observed.entry(object.id).or_insert_with(|| (object, BTreeSet::new())).1.insert(image.frame);
        }
    }
    let cameras: Vec<&str> = set.cameras.iter().map(String::as_str).collect();
    let mut systems = Map::new();
    systems.insert(WORLD.to_owned(), json!({ "type": "scene_cs", "parent": "", "children": cameras }));
    systems.extend(
        cameras
            .iter()
            .map(|camera| ((*camera).to_owned(), json!({ "type": "sensor_cs", "parent": WORLD, "children": [] }))),
    );
    let streams = cameras.iter().filter_map(|camera| {
        let image = record.pictures.iter().find(|image| image.camera == *camera)?;
        Some(((*camera).to_owned(), stream(image)))
    });
    let objects = observed.iter().map(|(id, (object, frames))| {
        let facts = json!({ "name": object.name, "type": object.class, "frame_intervals": intervals(frames) });
        (id.to_string(), facts)
    });
    json!({
        "metadata": { "schema_version": "1.0.0", "annotator": format!("etendue {}", env!("CARGO_PKG_VERSION")), "name": format!("sample {}", record.sample) },
        "coordinate_systems": systems,
        "streams": streams.collect::<Map<_, _>>(),
        "frame_intervals": intervals(&frames.keys().copied().collect()),
        "frames": frames.iter().map(|(number, images)| (number.to_string(), frame(record.sample, images))).collect::<Map<_, _>>(),
        "objects": objects.collect::<Map<_, _>>(),
    })
}

/// Objects with a class and a visible pixel.
fn labelled(image: &ImageRecord) -> impl Iterator<Item = &ObjectRecord> {
    image.visible().map(|(object, ..)| object).filter(|object| object.class.is_some())
}

fn stream(image: &ImageRecord) -> Value {
    let Some([fx, skew, cx, fy, cy]) = image.camera_matrix_px else { return json!({ "type": "camera" }) };
    let matrix = [fx, skew, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    let intrinsics = json!({
        "width_px": image.width_px, "height_px": image.height_px, "camera_matrix_3x4": matrix, "distortion_coeffs_1xN": [0.0, 0.0, 0.0, 0.0],
    });
    json!({ "type": "camera", "stream_properties": { "intrinsics_pinhole": intrinsics } })
}

/// Runs of consecutive numbers.
fn intervals(frames: &BTreeSet<u32>) -> Vec<Value> {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for frame in frames {
        match runs.last_mut() {
            Some((_, end)) if *end + 1 == *frame => *end = *frame,
            _ => runs.push((*frame, *frame)),
        }
    }
    runs.into_iter().map(|(start, end)| json!({ "frame_start": start, "frame_end": end })).collect()
}

fn frame(sample: u32, images: &[&ImageRecord]) -> Value {
    let streams = images.iter().map(|image| {
        let facts = json!({ "uri": uri(sample, image), "stream_properties": { "sync": { "timestamp": image.exact_time().to_string() } } });
        (image.camera.clone(), facts)
    });
    let transforms = images.iter().map(|image| {
        let facts =
            json!({ "src": image.camera, "dst": WORLD, "transform_src_to_dst": { "matrix4x4": matrix(&image.pose) } });
        (format!("{}_to_{WORLD}", image.camera), facts)
    });
    let mut objects: BTreeMap<u32, (Vec<Value>, Vec<Value>, Value)> = BTreeMap::new();
    for image in images {
        for (object, _, [left, top, right, bottom]) in image.visible().filter(|(object, ..)| object.class.is_some()) {
            let (boxes, shares, solid) =
                objects.entry(object.id).or_insert_with(|| (Vec::new(), Vec::new(), cuboid(object)));
            let (centre, size) = ([(left + right) / 2.0, (top + bottom) / 2.0], [right - left, bottom - top]);
            let key = |name: &str| format!("{name}_{}", image.camera);
            boxes.push(json!({ "name": key("bbox"), "val": [centre[0], centre[1], size[0], size[1]], "coordinate_system": image.camera }));
            shares.push(json!({ "name": key("visible_fraction"), "val": object.visible_fraction }));
            *solid = cuboid(object);
        }
    }
    let objects = objects.into_iter().map(|(id, (boxes, shares, solid))| {
        (id.to_string(), json!({ "object_data": { "bbox": boxes, "cuboid": [solid], "num": shares } }))
    });
    let times = images.iter().map(|image| image.exact_time());
    let first = times.reduce(|a, b| if b < a { b } else { a }).unwrap_or_default();
    json!({
        "frame_properties": {
            "timestamp": first.to_string(),
            "streams": streams.collect::<Map<_, _>>(),
            "transforms": transforms.collect::<Map<_, _>>(),
        },
        "objects": objects.collect::<Map<_, _>>(),
    })
}

/// Matrix from camera to world, row by row.
fn matrix(pose: &Pose) -> [f64; 16] {
    let [w, x, y, z] = pose.rotation_wxyz;
    let place = DVec3::from_array(pose.position_m);
    DMat4::from_rotation_translation(DQuat::from_xyzw(x, y, z, w), place).transpose().to_cols_array()
}

fn cuboid(object: &ObjectRecord) -> Value {
    let solid = &object.box_3d;
    let [w, qx, qy, qz] = solid.world.rotation_wxyz;
    let ([x, y, z], [sx, sy, sz]) = (solid.world.centre_m, solid.size_m);
    json!({ "name": "box_3d", "val": [x, y, z, qx, qy, qz, w, sx, sy, sz], "coordinate_system": WORLD })
}
