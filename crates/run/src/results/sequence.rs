//! Results of cameras during writing, and files over all frames at the end: tracks of objects, videos, and each camera's side-car.

use super::camera::CameraResults;
use super::writer::ResultWriter;
use super::{levels, metadata};
use crate::result_files::ResultFiles;
use crate::rig::{self, RigFiles};
use etendue_core::observer::Observer;
use etendue_io::exr::{ExrImage, rays_image};
use etendue_io::failure::Error;
use etendue_io::picture::read_image;
use etendue_io::y4m::{VideoFacts, write_frame, write_head};
use etendue_io::{FileDigest, OutputFolder, Provenance, read_regular};
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence};
use etendue_pipeline::rays::{RayTable, ray_table};
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_scene::limits::DESCRIPTION;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::io;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Frames of a run, and the files written for each camera.
#[derive(Debug)]
pub(crate) struct FrameSequence {
    frames: Range<u32>,
    /// Files common to all cameras.
    rig: RigFiles,
    cameras: Vec<CameraFrames>,
}

/// Files written for a camera.
#[derive(Debug)]
struct CameraFrames {
    plan: Arc<Plan>,
    /// Index of the camera in the plan.
    camera: usize,
    /// Range of its frames.
    frames: Range<u32>,
    /// Side-car facts of each frame that has an image or its own light.
    facts: BTreeMap<u32, Value>,
    /// True if this run has written the pixels' rays.
    has_rays: bool,
}

impl CameraFrames {
    fn camera(&self) -> &CameraPlan {
        &self.plan.cameras[self.camera]
    }
}

impl FrameSequence {
    /// Returns the frames of a plan, with nothing written yet.
    pub(crate) fn new(plan: &Plan, frames: Range<u32>) -> Self {
        Self { rig: rig::requested_files(plan, &frames), frames, cameras: Vec::new() }
    }

    /// The frames of the run.
    pub(crate) fn frames(&self) -> &Range<u32> {
        &self.frames
    }

    /// The names, relative to the output folder, of all files of a plan.
    pub(crate) fn file_names(&self, plan: &Plan) -> Vec<String> {
        let mut names = camera_file_names(plan, &self.frames);
        names.extend(self.rig.files.iter().map(|(name, _)| name.clone()));
        names
    }

    /// Writes all files of a camera's results except its side-car.
    pub(crate) fn write(
        &mut self,
        results: &CameraResults,
        folder: &mut OutputFolder,
        observer: &dyn Observer,
    ) -> Result<(), Error> {
        let camera = results.camera();
        let numbers = results.frame_numbers();
        let known = self.camera_frames(&results.plan, camera, &numbers);
        if !known.has_rays {
            known.has_rays = true;
            write_rays(camera, &metadata::provenance(&results.plan, camera, known.frames.start), folder)?;
        }
        let mut frames = results.write_files(folder, observer)?;
        if results.has_own_light() {
            let facts = metadata::own_frame(&results.plan, camera, numbers.start, frames.pop());
            let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
            let stored_facts = match results.state_after() {
                Some(after) => metadata::with_state(facts.clone(), &after.state, after.since),
                None => facts.clone(),
            };
            let files = files_of_frame(camera, numbers.start, writer.folder)?;
            writer.json(&ResultFiles::frame(numbers.start), &metadata::with_seal(stored_facts, &files))?;
            frames = vec![facts];
        }
        let known = self.camera_frames(&results.plan, camera, &numbers);
        known.facts.extend(numbers.zip(frames));
        Ok(())
    }

    /// Registers a frame written by an earlier run.
    pub(crate) fn register(&mut self, plan: &Arc<Plan>, camera: &CameraPlan, frame: u32, facts: Value) {
        self.camera_frames(plan, camera, &(frame..frame + 1)).facts.insert(frame, facts);
    }

    /// Writes the files over all frames and cameras, and the side-cars; reports each camera's levels.
    pub(crate) fn finish(&self, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<(), Error> {
        for known in &self.cameras {
            let camera = known.camera();
            let files = ResultFiles::for_camera(camera, &known.frames);
            let mut facts = metadata::sidecar(&known.plan, camera, known.frames.start, &files);
            let rectified =
                camera.products.undistorted.and_then(|scale| RectifiedCamera::new(&camera.body, scale).ok());
            facts["undistorted"] = rectified.as_ref().map_or(Value::Null, metadata::undistorted);
            facts["frames"] = known.facts.values().cloned().collect();
            if !known.has_rays {
                let facts = metadata::provenance(&known.plan, camera, known.frames.start);
                write_rays(camera, &facts, folder)?;
            }
            if camera.products.annotations.tracks {
                write_tracks(camera, &known.frames, folder)?;
            }
            if camera.products.video {
                write_video(camera, &known.frames, folder)?;
            }
            let mut writer = ResultWriter { prefix: camera.name.clone(), folder: &mut *folder };
            writer.json(ResultFiles::SIDECAR, &facts)?;
            levels::report(&camera.name, known.facts.values(), observer);
        }
        rig::write(&self.rig, folder, observer)
    }

    fn camera_frames(&mut self, plan: &Arc<Plan>, camera: &CameraPlan, frames: &Range<u32>) -> &mut CameraFrames {
        let place = self.cameras.iter().position(|known| known.camera().name == camera.name);
        let place = place.unwrap_or_else(|| {
            let index = plan.cameras.iter().position(|c| c.name == camera.name).expect("a camera of the plan");
            let (plan, facts) = (Arc::clone(plan), BTreeMap::new());
            let frames = frames.clone();
            self.cameras.push(CameraFrames { plan, camera: index, frames, facts, has_rays: false });
            self.cameras.len() - 1
        });
        let known = &mut self.cameras[place];
        known.frames = known.frames.start.min(frames.start)..known.frames.end.max(frames.end);
        known
    }
}

/// Digests of the files of a frame, which are written but not yet published, by their names in the camera's folder.
fn files_of_frame(
    camera: &CameraPlan,
    frame: u32,
    folder: &OutputFolder,
) -> Result<BTreeMap<String, FileDigest>, Error> {
    let prefix = format!("{}/", camera.name);
    // Files over all frames have no number; other frames of the run may also wait for publication.
    let number = format!(".{frame:04}.");
    let is_own = |name: &str| name.starts_with(&prefix) && name.contains(&number);
    let digests = folder.pending_digests(is_own).map_err(Error::run)?;
    Ok(digests.into_iter().map(|(name, digest)| (name[prefix.len()..].to_owned(), digest)).collect())
}

/// Writes the data common to all frames: the pixels' rays.
fn write_rays(camera: &CameraPlan, facts: &Provenance, folder: &mut OutputFolder) -> Result<(), Error> {
    if !camera.products.rays {
        return Ok(());
    }
    let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
    writer.exr(ResultFiles::RAYS, image_of_rays(&ray_table(&camera.body), facts))?;
    let rectified = camera.products.undistorted.and_then(|scale| RectifiedCamera::new(&camera.body, scale).ok());
    let Some(rectified) = rectified else { return Ok(()) };
    let facts = metadata::undistorted_provenance(facts.clone(), &rectified);
    writer.exr(&ResultFiles::undistorted(ResultFiles::RAYS), image_of_rays(&ray_table(rectified.body()), &facts))
}

fn image_of_rays<'a>(table: &'a RayTable, facts: &Provenance) -> ExrImage<'a> {
    rays_image(&table.origin, &table.direction, &table.ray, table.path.as_ref(), facts)
}

/// Keys of a track that describe its object, not its frames.
const OF_OBJECT: [&str; 3] = ["id", "name", "class"];

/// Frame keys that are copied from the boxes.
const OF_FRAME: [&str; 3] = ["frame", "time_s", "time"];

/// Writes `tracks.json`.
fn write_tracks(camera: &CameraPlan, frames: &Range<u32>, folder: &mut OutputFolder) -> Result<(), Error> {
    let files: Vec<String> = match camera.time {
        TimeDependence::None => vec![ResultFiles::BOXES.to_owned()],
        _ => frames.clone().map(|frame| ResultFiles::numbered(ResultFiles::BOXES, frame)).collect(),
    };
    let mut tracks = ObjectTracks::default();
    for file in files {
        tracks.add(read_boxes(&format!("{}/{file}", camera.name), folder)?);
    }
    let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
    writer.json(ResultFiles::TRACKS, &tracks.into_json(camera))
}

fn read_boxes(name: &str, folder: &OutputFolder) -> Result<Value, Error> {
    let path = folder.readable_path(name).map_err(Error::run)?;
    let unread = |why: String| Error::run(format!("{}: {why}", path.display()));
    let bytes = read_regular(&path, &DESCRIPTION).map_err(|cause| unread(format!("it cannot be read: {cause}")))?;
    serde_json::from_slice(&bytes).map_err(|_| unread("this is not a file of a frame's bounding boxes".to_owned()))
}

/// Tracks read so far.
#[derive(Default)]
struct ObjectTracks {
    conventions: Value,
    frames: Vec<Value>,
    /// By identity: the object, and its frames.
    objects: BTreeMap<u64, (Value, Vec<Value>)>,
}

impl ObjectTracks {
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
            let (_, frames) =
                self.objects.entry(id).or_insert_with(|| (Value::Object(of_object.into_iter().collect()), Vec::new()));
            frames.push(object);
        }
        self.frames.push(Value::Object(moment));
    }

    fn into_json(mut self, camera: &CameraPlan) -> Value {
        let raster = &camera.body.raster;
        self.conventions["tracks"] = json!(
            "an object has an entry in \"frames\" for each frame in which it covers pixels, or would without occlusion"
        );
        let track = |(mut object, frames): (Value, Vec<Value>)| {
            object["frames"] = Value::Array(frames);
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

/// Writes the video, with one image in memory at a time.
fn write_video(camera: &CameraPlan, frames: &Range<u32>, folder: &mut OutputFolder) -> Result<(), Error> {
    let format = camera.body.picture_format();
    let file = |frame| folder.readable_path(&format!("{}/{}", camera.name, ResultFiles::picture(frame, format)));
    let files: Vec<PathBuf> = frames.clone().map(file).collect::<Result<_, _>>().map_err(Error::run)?;
    let period_s = camera.timing.period_s.expect("a compiled plan's video has a rate");
    let pitch = camera.body.raster.pitch_mm();
    let name = format!("{}/{}", camera.name, ResultFiles::VIDEO);
    let written = folder.write_with(&name, |out| {
        for (i, file) in files.iter().enumerate() {
            let ImageAsset { width, height, pixels, .. } = read_image(file).map_err(io::Error::other)?;
            let ImagePixels::Rgb8(pixels) = pixels else {
                return Err(io::Error::other(format!("{}: expected an 8-bit colour image", file.display())));
            };
            if i == 0 {
                let (width, height) = (width as usize, height as usize);
                let (frame_rate_hz, pixel_aspect) = (1.0 / period_s, pitch.x / pitch.y);
                write_head(out, &VideoFacts { width, height, frame_rate_hz, pixel_aspect })?;
            }
            write_frame(out, &pixels)?;
        }
        Ok(())
    });
    written.map_err(Error::run)
}

/// Names, relative to the output folder, of the files of all cameras of a plan.
fn camera_file_names(plan: &Plan, frames: &Range<u32>) -> Vec<String> {
    let of_camera = |camera: &CameraPlan| {
        let names = ResultFiles::for_camera(camera, frames).into_keys().chain([ResultFiles::SIDECAR.to_owned()]);
        names.map(|name| format!("{}/{name}", camera.name)).collect::<Vec<_>>()
    };
    plan.cameras.iter().flat_map(of_camera).collect()
}
