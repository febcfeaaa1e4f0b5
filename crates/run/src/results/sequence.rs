//! The results of cameras as they are written, and at the end each camera's side-car.

use super::camera::CameraResults;
use super::levels;
use super::metadata;
use super::tracks::write_tracks;
use super::video::write_video;
use super::writer::ResultWriter;
use crate::result_files::Files;
use etendue_core::observer::Observer;
use etendue_io::exr::{ExrImage, rays_image};
use etendue_io::failure::Error;
use etendue_io::{FileDigest, OutputFolder, Provenance};
use etendue_pipeline::plan::{CameraPlan, Plan};
use etendue_pipeline::rays::{RayTable, ray_table};
use etendue_pipeline::rectified::RectifiedCamera;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// What was written of each camera.
#[derive(Debug, Default)]
pub(crate) struct Sequence {
    cameras: Vec<CameraFrames>,
}

/// What was written of a camera.
#[derive(Debug)]
struct CameraFrames {
    plan: Arc<Plan>,
    /// Its place among the plan's cameras.
    camera: usize,
    /// The first and one past the last of its frames.
    frames: Range<u32>,
    /// What the side-car says of each frame that has photographs or a light of its own.
    facts: BTreeMap<u32, Value>,
    /// Whether this run has written the rays of the pixels.
    has_rays: bool,
}

impl CameraFrames {
    fn camera(&self) -> &CameraPlan {
        &self.plan.cameras[self.camera]
    }
}

impl Sequence {
    /// Writes all files of a camera's results but its side-car.
    pub(crate) fn write(
        &mut self,
        results: &CameraResults,
        folder: &mut OutputFolder,
        observer: &dyn Observer,
    ) -> Result<(), Error> {
        let camera = results.camera();
        let numbers = results.frame_numbers();
        let known = self.of(&results.plan, camera, &numbers);
        if !known.has_rays {
            known.has_rays = true;
            write_rays(camera, &metadata::provenance(&results.plan, camera, known.frames.start), folder)?;
        }
        let mut frames = results.write_files(folder, observer)?;
        if results.has_own_light() {
            let facts = metadata::own_frame(&results.plan, camera, numbers.start, frames.pop());
            let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
            let kept = match results.state_after() {
                Some(after) => metadata::with_state(facts.clone(), &after.state, after.since),
                None => facts.clone(),
            };
            let files = files_of_frame(camera, numbers.start, writer.folder)?;
            writer.json(&Files::frame(numbers.start), &metadata::sealed(kept, &files))?;
            frames = vec![facts];
        }
        let known = self.of(&results.plan, camera, &numbers);
        known.facts.extend(numbers.zip(frames));
        Ok(())
    }

    /// Notes a frame that a run before this one has written.
    pub(crate) fn keep(&mut self, plan: &Arc<Plan>, camera: &CameraPlan, frame: u32, facts: Value) {
        self.of(plan, camera, &(frame..frame + 1)).facts.insert(frame, facts);
    }

    /// Writes what is made of all frames, and the side-cars, and reports each camera's levels.
    pub(crate) fn finish(&self, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<(), Error> {
        for known in &self.cameras {
            let camera = known.camera();
            let files = Files::of_camera(camera, &known.frames);
            let mut facts = metadata::sidecar(&known.plan, camera, known.frames.start, &files);
            let twin = camera.products.undistorted.and_then(|scale| RectifiedCamera::of(&camera.body, scale).ok());
            facts["undistorted"] = twin.as_ref().map_or(Value::Null, metadata::undistorted);
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
            writer.json(Files::SIDECAR, &facts)?;
            levels::report(&camera.name, known.facts.values(), observer);
        }
        Ok(())
    }

    fn of(&mut self, plan: &Arc<Plan>, camera: &CameraPlan, frames: &Range<u32>) -> &mut CameraFrames {
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

/// The digests of the files of a frame, which have been written and have no final names yet, by their names in the camera's folder.
fn files_of_frame(
    camera: &CameraPlan,
    frame: u32,
    folder: &OutputFolder,
) -> Result<BTreeMap<String, FileDigest>, Error> {
    let prefix = format!("{}/", camera.name);
    // What is of all frames has no number; other frames of the run may wait for their names as well.
    let number = format!(".{frame:04}.");
    let is_own = |name: &str| name.starts_with(&prefix) && name.contains(&number);
    let digests = folder.pending_digests(is_own).map_err(Error::run)?;
    Ok(digests.into_iter().map(|(name, digest)| (name[prefix.len()..].to_owned(), digest)).collect())
}

/// Writes what is the same in all frames: the rays of the pixels.
fn write_rays(camera: &CameraPlan, facts: &Provenance, folder: &mut OutputFolder) -> Result<(), Error> {
    if !camera.products.rays {
        return Ok(());
    }
    let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
    writer.exr(Files::RAYS, image_of_rays(&ray_table(&camera.body), facts))?;
    let twin = camera.products.undistorted.and_then(|scale| RectifiedCamera::of(&camera.body, scale).ok());
    let Some(twin) = twin else { return Ok(()) };
    let facts = metadata::undistorted_provenance(facts.clone(), &twin);
    writer.exr(&Files::undistorted(Files::RAYS), image_of_rays(&ray_table(twin.body()), &facts))
}

fn image_of_rays<'a>(table: &'a RayTable, facts: &Provenance) -> ExrImage<'a> {
    rays_image(&table.origin, &table.direction, &table.ray, table.path.as_ref(), facts)
}
