//! Frames that an interrupted run has written: the resumed run continues after them.

use super::metadata;
use super::sequence::FrameSequence;
use crate::result_files::ResultFiles;
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::read_regular;
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence};
use etendue_scene::limits::DESCRIPTION;
use etendue_sensor::{Sensor, SensorState};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Frames written by a run of the same plan, by camera and number, with their facts.
#[derive(Clone, Debug, Default)]
pub(crate) struct DoneFrames {
    facts: BTreeMap<(String, u32), Value>,
    /// The run's first frame, with which the state of sensors starts.
    first: u32,
}

impl DoneFrames {
    /// Finds the complete frames in a folder of results. A frame's own file is written last and states the digests of all others: the frame is complete if it
    /// and they are unchanged. Other frames are rendered again, and the observer is informed.
    ///
    /// # Errors
    /// A frame or a side-car in the folder is of another plan, or cannot be read.
    pub(crate) fn find_in_folder(
        folder: &Path,
        plan: &Plan,
        frames: &Range<u32>,
        observer: &dyn Observer,
    ) -> Result<Self, Error> {
        let mut facts = BTreeMap::new();
        for camera in plan.cameras.iter().filter(|camera| camera.time != TimeDependence::None) {
            for frame in frames.clone() {
                let path = folder.join(&camera.name).join(ResultFiles::frame(frame));
                let Some(value) = read_facts(&path, "this is not a frame file")? else { continue };
                if value["plan_hash"] != plan.hash_text() {
                    let why = "it is a frame of another plan; choose another output folder, or `overwrite` it";
                    return Err(error(&path, why));
                }
                if let Err(why) = metadata::check_seal(&value, frame, &folder.join(&camera.name)) {
                    let sentence =
                        format!("{}: {why}; frame {frame} of {} is rendered again", path.display(), camera.name);
                    observer.message(Message::Note(&sentence));
                    continue;
                }
                facts.insert((camera.name.clone(), frame), value);
            }
        }
        plan.cameras.iter().try_for_each(|camera| check_sidecar(&folder.join(&camera.name), plan))?;
        Ok(Self { facts, first: frames.start })
    }

    /// States of the sensors of cameras after a frame; `None` if it is incomplete for any of them, or a sensor's state started with another frame.
    pub(crate) fn states(&self, group: &[&CameraPlan], frame: u32) -> Option<Vec<SensorState>> {
        group.iter().map(|camera| self.state(camera, frame)).collect()
    }

    fn state(&self, camera: &CameraPlan, frame: u32) -> Option<SensorState> {
        let facts = self.frame_facts(camera, frame)?;
        match camera.body.sensor.as_ref().is_some_and(Sensor::has_memory) {
            true => metadata::state_of(facts, self.first),
            false => Some(SensorState::default()),
        }
    }

    /// Registers the frames in a sequence that continues after them.
    pub(crate) fn register_all(&self, plan: &Arc<Plan>, sequence: &mut FrameSequence) {
        let frames = sequence.frames().clone();
        for group in plan.by_light() {
            for frame in frames.clone().filter(|frame| self.states(&group, *frame).is_some()) {
                let facts = |camera: &CameraPlan| self.frame_facts(camera, frame).cloned().map(metadata::without_state);
                group.iter().for_each(|camera| {
                    facts(camera).into_iter().for_each(|facts| sequence.register(plan, camera, frame, facts));
                });
            }
        }
    }

    fn frame_facts(&self, camera: &CameraPlan, frame: u32) -> Option<&Value> {
        self.facts.get(&(camera.name.clone(), frame))
    }
}

/// Refuses the results of a complete run of another plan: of cameras with constant light no other file states the plan.
fn check_sidecar(folder: &Path, plan: &Plan) -> Result<(), Error> {
    let path = folder.join(ResultFiles::SIDECAR);
    match read_facts(&path, "this is not the side-car of a camera")? {
        Some(facts) if facts["plan_hash"] != plan.hash_text() => {
            let why = "it belongs to a run of another plan; choose another output folder, or `overwrite` it";
            Err(error(&path, why))
        }
        _ => Ok(()),
    }
}

/// Reads a file of facts; `None` if there is none.
fn read_facts(path: &Path, otherwise: &str) -> Result<Option<Value>, Error> {
    let bytes = match read_regular(path, &DESCRIPTION) {
        Ok(bytes) => bytes,
        Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(None),
        Err(cause) => return Err(error(path, &format!("it cannot be read: {cause}"))),
    };
    let value = serde_json::from_slice(&bytes);
    value.map(Some).map_err(|_| error(path, &format!("{otherwise}; remove it, or choose another output folder")))
}

fn error(path: &Path, why: &str) -> Error {
    Error::coded(ErrorCode::OtherRun, format!("{}: {why}", path.display()))
}
