//! Storage of a run: results of an earlier run, light after each pass, and the results, in an output folder.
//!
//! A progressive run stores the state of its films after each pass and refines the images on disk. These are the final files of light and frames, made from
//! the film so far: complete, and each replaced as a whole. Where one light serves many frames, the first frame is refined. Other captures of a frame and
//! earlier frames are then known: a frame with several films is refined with the last of them.

use super::films::check_finite;
use crate::film_file::{self, FilmOrigin, StoredPasses, holds_state, state_name};
use crate::job_request::{JobRequest, RenderOptions};
use crate::results::{CameraResults, DoneFrames, FrameSequence};
use etendue_core::observer::{Message, NullObserver, Observer};
use etendue_io::failure::Error;
use etendue_io::{ExistingFiles, OutputFolder};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::FrameCapture;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Stored light of a film.
#[derive(Debug)]
pub(crate) enum StoredLight {
    None,
    /// Light of some passes, from an interrupted run.
    Passes(Film, StoredPasses),
    /// All of the light, from shards.
    Complete(Film),
}

/// Storage of a run: light and frames of earlier runs, and its own light after each pass.
pub(crate) trait RunStore {
    /// Returns the stored light of a film.
    fn light(&self, _origin: &FilmOrigin<'_>) -> Result<StoredLight, Error> {
        Ok(StoredLight::None)
    }

    /// Returns the frames whose results an earlier run of the plan has written. Called once, when the plan's passes are known.
    fn done_frames(&mut self, _plan: &Arc<Plan>) -> Result<DoneFrames, Error> {
        Ok(DoneFrames::default())
    }

    /// Returns true if the store acts after each pass.
    fn stores_passes(&self) -> bool {
        false
    }

    /// Stores a film after some of its passes.
    fn store(&mut self, _origin: &FilmOrigin<'_>, _film: &Film, _passes: &StoredPasses) -> Result<(), Error> {
        Ok(())
    }

    /// Refines the images of a frame with the results of its cameras so far.
    fn refine(&mut self, _results: &mut dyn Iterator<Item = Result<CameraResults, Error>>) -> Result<(), Error> {
        Ok(())
    }
}

/// Stores nothing.
pub(crate) struct NoStore;

impl RunStore for NoStore {}

/// The output folder of a run.
pub(crate) struct RunFolder<'a> {
    interruption: InterruptionNote<'a>,
    folder: OutputFolder,
    /// State of runs that can resume and be resumed: all except `merge`.
    state: Option<RunState>,
    /// Frames written by an earlier run; `None` if they are known only after the light.
    done: Option<DoneFrames>,
    sequence: FrameSequence,
    written: Vec<PathBuf>,
    observer: &'a dyn Observer,
}

/// The state of a run.
struct RunState {
    /// Folder of the state and of the refined images, in a progressive run.
    progressive: Option<OutputFolder>,
    /// Folder of the earlier run, in a resumed run.
    resumed: Option<PathBuf>,
}

impl<'a> RunFolder<'a> {
    /// Opens the folder of a run. A run that replaces existing files starts afresh.
    ///
    /// # Errors
    /// Files exist that must not be replaced, the state is that of another run, or the folder cannot be written.
    pub(crate) fn open(
        request: &JobRequest,
        plan: &Arc<Plan>,
        options: &RenderOptions,
        root: &Path,
        existing: ExistingFiles,
        observer: &'a dyn Observer,
    ) -> Result<Self, Error> {
        let sequence = FrameSequence::new(plan, options.frames.clone());
        let folder = OutputFolder::open(root, existing).map_err(Error::input)?;
        let resumed = (existing == ExistingFiles::Resume).then(|| root.to_path_buf());
        // In a run of a given time, the plan of the frames is known after its passes.
        let done = match (&resumed, request.time_s) {
            (Some(root), None) => Some(DoneFrames::find_in_folder(root, plan, sequence.frames(), observer)?),
            _ => None,
        };
        film_file::check_state(&folder, existing)?;
        check_absent(&folder, plan, &sequence)?;
        let folder = if request.progressive { folder.replacing_own() } else { folder };
        let open_again = || folder.reopened(ExistingFiles::Replace).map_err(Error::input);
        let progressive = request.progressive.then(open_again).transpose()?;
        if existing == ExistingFiles::Replace {
            film_file::remove_state(&folder).map_err(Error::run)?;
        }
        let state = Some(RunState { progressive, resumed });
        Ok(Self { state, done, ..Self::new(folder, sequence, observer) })
    }

    /// Opens the folder for the results of shards.
    ///
    /// # Errors
    /// Files exist that must not be replaced, or the folder cannot be written.
    pub(crate) fn for_shards(
        plan: &Arc<Plan>,
        options: &RenderOptions,
        root: &Path,
        existing: ExistingFiles,
        observer: &'a dyn Observer,
    ) -> Result<Self, Error> {
        let folder = OutputFolder::open(root, existing).map_err(Error::input)?;
        let sequence = FrameSequence::new(plan, options.frames.clone());
        check_absent(&folder, plan, &sequence)?;
        Ok(Self::new(folder, sequence, observer))
    }

    fn new(folder: OutputFolder, sequence: FrameSequence, observer: &'a dyn Observer) -> Self {
        let interruption = InterruptionNote::new(&folder, observer);
        Self { interruption, folder, state: None, done: None, sequence, written: Vec::new(), observer }
    }

    /// Writes a camera's results. The files of a frame with its own light are published at once.
    ///
    /// # Errors
    /// A file cannot be made or written.
    pub(crate) fn write(&mut self, results: &CameraResults) -> Result<(), Error> {
        self.sequence.write(results, &mut self.folder, self.observer)?;
        let Some(state) = self.state.as_ref().filter(|_| results.has_own_light()) else { return Ok(()) };
        self.written.extend(self.folder.publish().map_err(Error::run)?);
        self.interruption.frames += 1;
        state.remove_frame_state(results.camera(), results.frame_numbers().start)
    }

    /// Writes the files over all frames and cameras, publishes all files, and removes the state; returns the paths of all files.
    ///
    /// # Errors
    /// A file cannot be made, written or removed.
    pub(crate) fn finish(mut self) -> Result<Vec<PathBuf>, Error> {
        self.sequence.finish(&mut self.folder, self.observer)?;
        self.written.extend(self.folder.publish().map_err(Error::run)?);
        if self.state.is_some() {
            film_file::remove_state(&self.folder).map_err(Error::run)?;
        }
        self.interruption.is_complete = true;
        Ok(self.written)
    }
}

/// Fails early if a result already exists.
fn check_absent(folder: &OutputFolder, plan: &Plan, sequence: &FrameSequence) -> Result<(), Error> {
    folder.claim(sequence.file_names(plan).iter().map(String::as_str)).map_err(Error::input)
}

impl RunState {
    /// Removes the stored state of a frame whose files are written.
    fn remove_frame_state(&self, camera: &CameraPlan, frame: u32) -> Result<(), Error> {
        let Some(folder) = &self.progressive else { return Ok(()) };
        let captures = camera.body.exposure.distinct_captures();
        let names: Vec<String> = captures
            .into_iter()
            .map(|capture| state_name(camera, FrameCapture { frame, capture: capture as u32 }))
            .collect();
        folder.remove(names.iter().map(String::as_str)).map_err(Error::run)
    }
}

impl RunFolder<'_> {
    fn progressive(&mut self) -> Option<&mut OutputFolder> {
        self.state.as_mut()?.progressive.as_mut()
    }

    fn resumed(&self) -> Option<&Path> {
        self.state.as_ref()?.resumed.as_deref()
    }
}

impl RunStore for RunFolder<'_> {
    fn light(&self, origin: &FilmOrigin<'_>) -> Result<StoredLight, Error> {
        let Some(root) = self.resumed() else { return Ok(StoredLight::None) };
        match film_file::read_state(root, origin)? {
            Some((film, passes)) => Ok(StoredLight::Passes(film, passes)),
            None => Ok(StoredLight::None),
        }
    }

    fn done_frames(&mut self, plan: &Arc<Plan>) -> Result<DoneFrames, Error> {
        let done = match (self.done.take(), self.resumed()) {
            (Some(done), _) => done,
            (None, Some(root)) => DoneFrames::find_in_folder(root, plan, self.sequence.frames(), self.observer)?,
            (None, None) => DoneFrames::default(),
        };
        done.register_all(plan, &mut self.sequence);
        Ok(done)
    }

    fn stores_passes(&self) -> bool {
        self.state.as_ref().is_some_and(|state| state.progressive.is_some())
    }

    fn store(&mut self, origin: &FilmOrigin<'_>, film: &Film, passes: &StoredPasses) -> Result<(), Error> {
        let Some(folder) = self.progressive() else { return Ok(()) };
        check_finite(origin.camera, film)?;
        film_file::write_state(folder, origin, film, passes)?;
        folder.publish().map_err(Error::run)?;
        Ok(())
    }

    fn refine(&mut self, results: &mut dyn Iterator<Item = Result<CameraResults, Error>>) -> Result<(), Error> {
        let Some(folder) = self.progressive() else { return Ok(()) };
        for camera in results {
            camera?.write_light(folder, &NullObserver)?;
        }
        folder.publish().map_err(Error::run)?;
        Ok(())
    }
}

/// Reports, when dropped before the run is complete, what a failed, cancelled or panicked run leaves in its folder.
pub(crate) struct InterruptionNote<'a> {
    root: PathBuf,
    observer: &'a dyn Observer,
    /// Number of written frames over all cameras.
    frames: usize,
    /// True once all files are written.
    pub(crate) is_complete: bool,
}

impl<'a> InterruptionNote<'a> {
    /// A note for a run that now starts to write into a folder.
    pub(crate) fn new(folder: &OutputFolder, observer: &'a dyn Observer) -> Self {
        Self { root: folder.path().to_path_buf(), observer, frames: 0, is_complete: false }
    }

    fn text(&self) -> String {
        let frames = match self.frames {
            0 => None,
            1 => Some("1 complete frame".to_owned()),
            n => Some(format!("{n} complete frames")),
        };
        let light = holds_state(&self.root).then(|| "the light of the last complete pass".to_owned());
        let left: Vec<String> = frames.into_iter().chain(light).collect();
        let folder = self.root.display();
        match left.is_empty() {
            true => format!("{folder}: nothing of this run was saved"),
            false => {
                format!("{folder}: saved {}; to continue, use `resume` instead of `overwrite`", left.join(" and "))
            }
        }
    }
}

impl Drop for InterruptionNote<'_> {
    fn drop(&mut self) {
        if !self.is_complete {
            self.observer.message(Message::Note(&self.text()));
        }
    }
}
