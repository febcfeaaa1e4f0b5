//! Compiles a job file and its changes to a plan, and renders a plan to results.

use crate::job_request::{JobRequest, RenderOptions};
use crate::memory::MemoryFiles;
use crate::memory_limits;
use crate::results::{CameraResults, FrameSequence, Results};
use crate::rig;
use crate::run::Run;
use crate::run::films::check_frames;
use crate::run::store::{NoStore, RunFolder};
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::Error;
use etendue_io::{CacheUse, ExistingFiles, OutputFolder, complete_assets};
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::report::RunMemory;
use etendue_pipeline::report::effects::PlannedEffect;
use etendue_pipeline::summary::Summary;
use etendue_pipeline::{Plan, compile};
use etendue_plan_report::PlanReport;
use etendue_scene::Description;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl JobRequest {
    /// Reads, checks and compiles the job. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// All errors of the job and of the files that it names.
    pub fn open(self) -> Result<Job, Error> {
        self.open_in(&MemoryFiles::new())
    }

    /// Does the same as [`open`](Self::open), with files in memory. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// All errors of the job and of the files that it names.
    pub fn open_in(self, files: &MemoryFiles) -> Result<Job, Error> {
        self.check()?;
        let sandbox = self.folders()?.recording();
        let description = Description::load(&self.job, &|path| files.read(path, &sandbox), &self.overrides());
        let description = description.map_err(|errors| Error::inputs(errors.as_slice()))?;
        let assets = complete_assets(files.assets().clone(), &description.assets(), &self.texture_memory(), &sandbox);
        let assets = assets.map_err(Error::inputs)?;
        let plan = compile(&description, &assets, &self.choices()).map_err(Error::inputs)?;
        let mut plan = self.narrowed(plan)?;
        // Scratch files are removed at the end.
        let stays = self.textures.cache_use == CacheUse::KeepInOutput;
        plan.film_limit = Some(self.films.limit(self.textures.cache.as_ref().filter(|_| !stays)));
        let (plan, mut files) = (Arc::new(plan), sandbox.requested_files());
        files.retain(|path| path.is_file());
        Ok(Job { request: self, plan, files: files.into() })
    }
}

/// A job that was read, checked and compiled. After this no error in the user's input remains.
#[derive(Clone, Debug)]
pub struct Job {
    request: JobRequest,
    plan: Arc<Plan>,
    files: Arc<[PathBuf]>,
}

impl Job {
    /// Opens a job file without changes; [`JobRequest::open`] opens it with changes. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// All errors of the job and of the files that it names.
    pub fn open(job: impl Into<PathBuf>) -> Result<Self, Error> {
        JobRequest::new(job).open()
    }

    /// The request that the job was opened with.
    #[must_use]
    pub fn request(&self) -> &JobRequest {
        &self.request
    }

    /// The plan: what is modelled.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The plan as text: what is modelled, what is left out and why, and the estimated cost.
    #[must_use]
    pub fn summary(&self) -> String {
        Summary(&self.plan).to_string()
    }

    /// The plan as machine-readable data.
    #[must_use]
    pub fn report(&self) -> PlanReport {
        PlanReport::new(&self.request.job, &self.plan)
    }

    /// All effects that can cost time or change a frame, by camera: whether each is modelled, its cost, and the changes of keys ([`JobRequest::set`]) that
    /// leave it out.
    #[must_use]
    pub fn effects(&self) -> Vec<(&CameraPlan, Vec<PlannedEffect>)> {
        self.plan.cameras.iter().map(|camera| (camera, self.plan.effects(camera))).collect()
    }

    /// Settings of the job file that the request overrides, one sentence each.
    #[must_use]
    pub fn overridden_settings(&self) -> &[String] {
        &self.plan.overridden_keys
    }

    /// The files that were read: the job and all files that it names, by the paths used. Files in memory are not included.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Names of all files of a complete run, relative to its output folder.
    #[must_use]
    pub fn file_names(&self, frames: &Range<u32>) -> Vec<String> {
        FrameSequence::new(&self.plan, frames.clone()).file_names(&self.plan)
    }

    /// Renders all cameras and keeps their light. For many large cameras [`render_each`](Self::render_each) holds one at a time.
    /// Runs on the caller's thread pool.
    ///
    /// # Errors
    /// The observer cancels, or light is not finite.
    pub fn render(&self, options: &RenderOptions, observer: &dyn Observer) -> Result<Results, Error> {
        let mut cameras = Vec::new();
        self.render_each(options, observer, |camera| {
            cameras.push(camera);
            Ok(())
        })?;
        Ok(Results::new(cameras))
    }

    /// Renders one camera after the other and passes the results of each to `take`. Cameras of equal light are rendered once and follow one another. Runs
    /// on the caller's thread pool.
    ///
    /// # Errors
    /// The observer cancels, light is not finite, or `take` fails.
    pub fn render_each(
        &self,
        options: &RenderOptions,
        observer: &dyn Observer,
        mut take: impl FnMut(CameraResults) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut run = self.run(options, observer)?;
        while let Some(results) = run.next_camera_results(&mut NoStore)? {
            take(results)?;
        }
        Ok(())
    }

    /// Renders one camera after the other (one frame after the other where light depends on time) and writes the files of each before it renders the next.
    /// Returns the paths of the written files. Files receive their final names when all are complete; those of a frame with its own light, when that frame is
    /// complete. An interrupted run keeps them, and a resumed run continues after them. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// The observer cancels, light is not finite, or the folder cannot be written.
    pub fn save(
        &self,
        options: &RenderOptions,
        folder: &Path,
        existing: ExistingFiles,
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        let mut folder = RunFolder::open(&self.request, &self.plan, options, folder, existing, observer)?;
        let mut run = self.run(options, observer)?;
        while let Some(results) = run.next_camera_results(&mut folder)? {
            folder.write(&results)?;
        }
        folder.finish()
    }

    /// Begins a run of all cameras.
    fn run<'a>(&self, options: &RenderOptions, observer: &'a dyn Observer) -> Result<Run<'a>, Error> {
        self.warn(observer);
        self.check_memory(&options.frames)?;
        Run::new(&self.plan, options, self.request.time_s, observer)
    }

    /// Writes poses and projections of all cameras over frames, in the formats of ROS, Kalibr and COLMAP; returns the paths. Nothing is
    /// rendered.
    ///
    /// # Errors
    /// Frames have no times, or the folder cannot be written.
    pub fn save_calibration_files(
        &self,
        frames: &Range<u32>,
        folder: &Path,
        existing: ExistingFiles,
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        check_frames(&self.plan, frames)?;
        let rig = rig::all_files(&self.plan, frames);
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        folder.claim(rig.files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
        self.plan.description_warnings().iter().for_each(|warning| observer.message(Message::Warning(warning)));
        rig::write(&rig, &mut folder, observer)?;
        folder.commit().map_err(Error::run)
    }

    /// Refuses, before the first sample, films that cannot be stored and a run of these frames that needs more memory than is free.
    fn check_memory(&self, frames: &Range<u32>) -> Result<(), Error> {
        let memory = RunMemory::new(&self.plan, rayon::current_num_threads());
        // A run of a given time holds the films of all cameras and frames.
        let memory = match self.request.time_s {
            Some(_) => memory.holding_films(&self.plan, frames.len()),
            None => memory,
        };
        memory_limits::check(&self.plan, &memory, &self.request.memory)
    }

    /// The same check for a shard, which renders films and writes nothing else.
    pub(crate) fn check_shard_memory(&self) -> Result<(), Error> {
        let memory = RunMemory::new(&self.plan, rayon::current_num_threads()).films_only();
        memory_limits::check(&self.plan, &memory, &self.request.memory)
    }

    pub(crate) fn shared_plan(&self) -> &Arc<Plan> {
        &self.plan
    }

    pub(crate) fn warn(&self, observer: &dyn Observer) {
        self.plan.warnings().iter().for_each(|warning| observer.message(Message::Warning(warning)));
    }
}
