//! The results of cameras as they are written, and at the end each camera's side-car.

use super::camera::CameraResults;
use super::files::Files;
use super::metadata;
use super::writer::ResultWriter;
use crate::error::Error;
use crate::observer::Observer;
use etendue_io::OutputFolder;
use etendue_pipeline::plan::{CameraPlan, Plan};
use serde_json::Value;
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
    /// The run's frames, as far as they were written.
    first: u32,
    end: u32,
    /// What the side-car says of the undistorted twin.
    undistorted: Value,
    /// What it says of each frame.
    frames: Vec<Value>,
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
        if !self.has(camera) {
            results.write_rays(folder)?;
        }
        let mut frames = results.write_files(folder, observer)?;
        if results.has_own_light() {
            let facts = metadata::own_frame(&results.plan, camera, numbers.start, frames.pop());
            let mut writer = ResultWriter { prefix: camera.name.clone(), folder };
            let kept = metadata::with_state(facts.clone(), results.state_after());
            writer.json(&Files::frame(numbers.start), &kept)?;
            frames = vec![facts];
        }
        let known = self.of(&results.plan, camera, numbers.start);
        known.end = numbers.end;
        known.undistorted = results.undistorted.as_ref().map_or(Value::Null, metadata::undistorted);
        known.frames.extend(frames);
        Ok(())
    }

    /// Notes a frame that a run before this one has written.
    pub(crate) fn keep(&mut self, plan: &Arc<Plan>, camera: &CameraPlan, frame: u32, facts: Value) {
        let known = self.of(plan, camera, frame);
        known.end = frame + 1;
        known.frames.push(facts);
    }

    /// Writes the side-cars.
    pub(crate) fn finish(&self, folder: &mut OutputFolder) -> Result<(), Error> {
        for known in &self.cameras {
            let camera = known.camera();
            let files = Files::of_camera(camera, &(known.first..known.end));
            let mut facts = metadata::sidecar(&known.plan, camera, known.first, &files);
            facts["undistorted"] = known.undistorted.clone();
            facts["frames"] = known.frames.clone().into();
            let mut writer = ResultWriter { prefix: camera.name.clone(), folder: &mut *folder };
            writer.json(Files::SIDECAR, &facts)?;
        }
        Ok(())
    }

    fn has(&self, camera: &CameraPlan) -> bool {
        self.cameras.iter().any(|known| known.camera().name == camera.name)
    }

    fn of(&mut self, plan: &Arc<Plan>, camera: &CameraPlan, frame: u32) -> &mut CameraFrames {
        let place = self.cameras.iter().position(|known| known.camera().name == camera.name);
        let place = place.unwrap_or_else(|| {
            let index = plan.cameras.iter().position(|c| c.name == camera.name).expect("a camera of the plan");
            let (plan, undistorted, frames) = (Arc::clone(plan), Value::Null, Vec::new());
            self.cameras.push(CameraFrames { plan, camera: index, first: frame, end: frame, undistorted, frames });
            self.cameras.len() - 1
        });
        &mut self.cameras[place]
    }
}
