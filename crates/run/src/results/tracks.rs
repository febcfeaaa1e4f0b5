//! The boxes of a camera's frames once more in one file, object by object, made of their files when all are there.

use super::writer::ResultWriter;
use crate::result_files::Files;
use etendue_io::failure::Error;
use etendue_io::{OutputFolder, read_regular};
use etendue_pipeline::plan::{CameraPlan, TimeDependence};
use etendue_scene::limits::DESCRIPTION;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a track says of its object, not of its frames.
const OF_OBJECT: [&str; 3] = ["id", "name", "class"];

/// Keys of the frame that are copied from the boxes.
const OF_FRAME: [&str; 3] = ["frame", "time_s", "time"];

/// Writes `tracks.json`.
pub(super) fn write_tracks(camera: &CameraPlan, frames: &Range<u32>, folder: &mut OutputFolder) -> Result<(), Error> {
    let files: Vec<String> = match camera.time {
        TimeDependence::None => vec![Files::BOXES.to_owned()],
        _ => frames.clone().map(|frame| Files::numbered(Files::BOXES, frame)).collect(),
    };
    let mut tracks = Tracks::default();
    for file in files {
        tracks.add(read(&format!("{}/{file}", camera.name), folder)?);
    }
    let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
    writer.json(Files::TRACKS, &tracks.into_json(camera))
}

fn read(name: &str, folder: &OutputFolder) -> Result<Value, Error> {
    let path = folder.readable(name).map_err(Error::run)?;
    let unread = |why: String| Error::run(format!("{}: {why}", path.display()));
    let bytes = read_regular(&path, &DESCRIPTION).map_err(|cause| unread(format!("it cannot be read: {cause}")))?;
    serde_json::from_slice(&bytes).map_err(|_| unread("this is not the file of a frame's boxes".to_owned()))
}

/// What was read so far.
#[derive(Default)]
struct Tracks {
    conventions: Value,
    frames: Vec<Value>,
    /// By identity: the object, and its frames.
    objects: BTreeMap<u64, (Value, Vec<Value>)>,
}

impl Tracks {
    /// Adds a frame's boxes.
    fn add(&mut self, mut boxes: Value) {
        let moment: Map<String, Value> =
            OF_FRAME.iter().filter_map(|key| Some(((*key).to_owned(), boxes.get(*key)?.clone()))).collect();
        self.conventions = boxes["conventions"].take();
        let Value::Array(objects) = boxes["objects"].take() else { return };
        for mut object in objects {
            let (Some(id), Some(keys)) = (object["id"].as_u64(), object.as_object_mut()) else { continue };
            let of_object = OF_OBJECT.map(|key| (key.to_owned(), keys.remove(key).unwrap_or(Value::Null)));
            keys.extend(moment.clone());
            let (_, seen) =
                self.objects.entry(id).or_insert_with(|| (Value::Object(of_object.into_iter().collect()), Vec::new()));
            seen.push(object);
        }
        self.frames.push(Value::Object(moment));
    }

    fn into_json(mut self, camera: &CameraPlan) -> Value {
        let raster = &camera.body.raster;
        self.conventions["tracks"] = json!(
            "an object has a place in \"frames\" for each frame in which it has pixels, or would if it stood alone"
        );
        let track = |(mut object, seen): (Value, Vec<Value>)| {
            object["frames"] = Value::Array(seen);
            object
        };
        json!({
            "camera": camera.name,
            "width_px": raster.width(),
            "height_px": raster.height(),
            "conventions": self.conventions,
            "frames": self.frames,
            "tracks": self.objects.into_values().map(track).collect::<Vec<_>>(),
        })
    }
}
