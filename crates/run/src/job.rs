//! From a job file and what changes it to a plan, and from a plan to results.

use crate::delivery::{SoFar, check_frames, deliver, films_of};
use crate::exposures::Exposures;
use crate::film_memory::FilmMemory;
use crate::integrator::Integrator;
use crate::memory::MemoryFiles;
use crate::memory_limits::MemoryLimits;
use crate::quality::Quality;
use crate::refine::{Progress, state, timed};
use crate::render_options::RenderOptions;
use crate::results::{CameraResults, DoneFrames, Kept, Results, Sequence, file_names};
use crate::rig;
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::Error;
use etendue_io::{CacheUse, Existing, OutputFolder, Sandbox, TextureMemory, complete_assets};
use etendue_pipeline::plan::{CameraPlan, Passes};
use etendue_pipeline::report::effects::PlannedEffect;
use etendue_pipeline::summary::Summary;
use etendue_pipeline::tile::Shard;
use etendue_pipeline::{Choices, Plan, Refinement, compile};
use etendue_plan_report::PlanReport;
use etendue_scene::{Description, Overrides};
use std::cell::RefCell;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The folder of tiles in an output folder, no name of a camera.
const TILES: &str = ".texture-cache";

/// A job file and what is changed in it: enough to make the same plan again.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobRequest {
    /// The job file (TOML).
    pub job: PathBuf,
    /// Changes of its keys, `key=value` as TOML writes the value, e.g. `render.spp=16` or `cameras.front.lens.f_number=4`.
    pub set: Vec<String>,
    /// Samples a pixel, over all replicates, of every camera; `None`: the job's, or the quality's.
    pub spp: Option<u64>,
    /// As many samples as it takes for a standard error of this part of the noise of the sensor; `None`: as the job says.
    pub noise: Option<f64>,
    /// As many samples as this much time of light allows, s, 10 or more: all cameras and frames together, from the first sample on, by the
    /// observer's clock; `None`: as the job says.
    pub time_s: Option<f64>,
    /// Whether light comes in passes, by a schedule that doubles where neither the job nor a time says others, and what is saved
    /// is refined and can be resumed after each.
    pub progressive: bool,
    /// Size of every camera's image over that of its sensor, `1/4` or `0.25`, with larger pixels; `None`: `sensor.scale` of each camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<String>,
    /// The integrator of every camera; `None`: the job's, or path.
    pub integrator: Option<Integrator>,
    /// A preset for what the job file leaves open.
    pub quality: Option<Quality>,
    /// The only camera to render, by its name; `None`: all of them.
    pub camera: Option<String>,
    /// The seed of all random numbers, at most 2⁶³ − 1; `None`: the job's, or 0.
    pub seed: Option<u64>,
    /// Folders beside the job's own that its files may lie in, however they are named: in the job, a base, a scene, a camera, a material library, a lamp or
    /// a change. `None`: files may lie anywhere. A shard keeps it for `merge`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sandbox: Option<Vec<PathBuf>>,
    /// How much memory textures may take, and where those are kept that take more. It belongs to the machine and not to the plan: files that state a
    /// request leave it out.
    #[serde(skip)]
    pub textures: TextureMemory,
    /// How much memory films may take, and where those are kept that take more. It belongs to the machine as well.
    #[serde(skip)]
    pub films: FilmMemory,
    /// The memory that is free for the run; a run that needs more is refused. It is a property of the machine as well; by default no limit is known.
    #[serde(skip)]
    pub memory: MemoryLimits,
}

impl JobRequest {
    /// A job file as it is.
    pub fn new(job: impl Into<PathBuf>) -> Self {
        Self {
            job: job.into(),
            set: Vec::new(),
            spp: None,
            noise: None,
            time_s: None,
            progressive: false,
            scale: None,
            integrator: None,
            quality: None,
            camera: None,
            seed: None,
            sandbox: None,
            textures: TextureMemory::default(),
            films: FilmMemory::default(),
            memory: MemoryLimits::default(),
        }
    }

    /// The same for a run into an output folder: the tiles of textures of a sandboxed job that names no folder for them are there, in `.texture-cache`.
    #[must_use]
    pub fn into_output(mut self, folder: &Path) -> Self {
        if self.sandbox.is_some() && self.textures.cache.is_none() {
            self.textures.cache = Some(folder.join(TILES));
            self.textures.cache_use = CacheUse::KeepInOutput;
        }
        self
    }

    /// Returns the memory limit of textures. A sandboxed job without a folder for tiles and without an output folder keeps all textures in memory: it writes
    /// nothing outside the folders that it may use.
    fn texture_memory(&self) -> TextureMemory {
        let has_no_folder =
            self.sandbox.is_some() && self.textures.cache.is_none() && self.textures.cache_use == CacheUse::Keep;
        let limit_bytes = if has_no_folder { u64::MAX } else { self.textures.limit_bytes };
        TextureMemory { limit_bytes, ..self.textures.clone() }
    }

    /// The same for what is told of a job without rendering it: no tiles of textures are written.
    #[must_use]
    pub fn without_tiles(mut self) -> Self {
        self.textures.cache_use = CacheUse::Read;
        self
    }

    /// Reads, checks and compiles the job. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// All faults of the job and of the files that it names.
    pub fn open(self) -> Result<Job, Error> {
        self.open_in(&MemoryFiles::new())
    }

    /// The same with files that a program made in memory. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// All faults of the job and of the files that it names.
    pub fn open_in(self, files: &MemoryFiles) -> Result<Job, Error> {
        self.check()?;
        let sandbox = self.folders()?.noting();
        let description = Description::load(&self.job, &|path| files.read(path, &sandbox), &self.overrides());
        let description = description.map_err(|faults| Error::inputs(faults.list()))?;
        let assets = complete_assets(files.assets().clone(), &description.assets(), &self.texture_memory(), &sandbox);
        let assets = assets.map_err(Error::inputs)?;
        let plan = compile(&description, &assets, &self.choices()).map_err(Error::inputs)?;
        let mut plan = self.narrowed(plan)?;
        // Scratch files leave nothing behind.
        let stays = self.textures.cache_use == CacheUse::KeepInOutput;
        plan.film_limit = Some(self.films.limit(self.textures.cache.as_ref().filter(|_| !stays)));
        let (plan, mut files) = (Arc::new(plan), sandbox.looked_for());
        files.retain(|path| path.is_file());
        Ok(Job { request: self, plan, files: files.into() })
    }

    /// Where the files of the job may lie.
    pub(crate) fn folders(&self) -> Result<Sandbox, Error> {
        let Some(further) = &self.sandbox else { return Ok(Sandbox::NONE) };
        Sandbox::about(&self.job, further).map_err(Error::input)
    }

    /// Refuses what excludes one another, and a time that cannot be kept.
    fn check(&self) -> Result<(), Error> {
        if self.textures.limit_bytes == 0 {
            return Err(Error::input("--texture-memory 0: textures need some memory; give 1 MB or more"));
        }
        let Some(time_s) = self.time_s else { return Ok(()) };
        if !(time_s.is_finite() && time_s >= timed::MIN_TIME_S) {
            return Err(Error::input(format!(
                "--time {time_s}: a time of {} s or more is kept; give --time {} or samples with --spp",
                timed::MIN_TIME_S,
                timed::MIN_TIME_S
            )));
        }
        match (self.spp, self.noise) {
            (None, None) => Ok(()),
            _ => Err(Error::input("--time decides the samples, and --spp or --noise would, too; give one of them")),
        }
    }

    /// The changes to the description: what is asked for goes through the same check as its key.
    pub(crate) fn overrides(&self) -> Overrides {
        let mut overrides = Overrides::new(&self.set);
        let mut flag = |name: &str, key, value: String, shown: &str| {
            overrides.push_render(&format!("--{name} {shown}"), key, &value);
        };
        if let Some(spp) = self.spp {
            flag("spp", "spp", spp.to_string(), &spp.to_string());
        }
        if let Some(noise) = self.noise {
            flag("noise", "noise_threshold", format!("{noise:?}"), &noise.to_string());
        }
        if let Some(seed) = self.seed {
            flag("seed", "seed", seed.to_string(), &seed.to_string());
        }
        if let Some(integrator) = self.integrator {
            let level = integrator.name();
            flag("integrator", "integrator", format!("\"{level}\""), level);
        }
        if let Some(scale) = &self.scale {
            overrides.push_sensor(&format!("--scale {scale}"), "scale", scale);
        }
        overrides
    }

    fn choices(&self) -> Choices {
        let quality = self.quality.map(|quality| match quality {
            Quality::Draft => etendue_pipeline::Quality::Draft,
            Quality::Standard => etendue_pipeline::Quality::Standard,
            Quality::Reference => etendue_pipeline::Quality::Reference,
        });
        let refinement = match (self.time_s, self.progressive) {
            (Some(_), _) => Refinement::Timed,
            (None, true) => Refinement::Progressive,
            (None, false) => Refinement::Described,
        };
        Choices { quality, refinement }
    }

    /// Only the camera that was asked for. Its random addresses are those it has among all.
    fn narrowed(&self, mut plan: Plan) -> Result<Plan, Error> {
        let Some(name) = &self.camera else { return Ok(plan) };
        if plan.camera(name).is_none() {
            let known: Vec<&str> = plan.cameras.iter().map(|c| c.name.as_str()).collect();
            return Err(Error::input(format!(
                "--camera {name}: {} has no camera of that name; give one of {}",
                self.job.display(),
                known.join(", ")
            )));
        }
        let right = plan.camera(name).and_then(|camera| camera.products.annotations.disparity).map(|d| d.right);
        if let Some(right) = plan.cameras.iter().find(|camera| Some(camera.index) == right) {
            return Err(Error::input(format!(
                "--camera {name}: its disparity_to names camera {}, which is then not in the run; render both, or leave the key out with --set",
                right.name
            )));
        }
        plan.cameras.retain(|camera| camera.name == *name);
        Ok(plan)
    }
}

/// A job that was read, checked and compiled: nothing after it fails because of what its user wrote.
#[derive(Clone, Debug)]
pub struct Job {
    request: JobRequest,
    plan: Arc<Plan>,
    files: Arc<[PathBuf]>,
}

impl Job {
    /// Opens a job file as it is; [`JobRequest::open`] opens it with changes. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// All faults of the job and of the files that it names.
    pub fn open(job: impl Into<PathBuf>) -> Result<Self, Error> {
        JobRequest::new(job).open()
    }

    /// What was asked for.
    #[must_use]
    pub fn request(&self) -> &JobRequest {
        &self.request
    }

    /// What will be modelled.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The plan in words: what is modelled, what is left out and why, and what it will cost.
    #[must_use]
    pub fn summary(&self) -> String {
        Summary(&self.plan).to_string()
    }

    /// The same for programs.
    #[must_use]
    pub fn report(&self) -> PlanReport {
        PlanReport::of(&self.request.job, &self.plan)
    }

    /// Everything that can cost or change a frame, by cameras: whether it is modelled, what it takes, and by which changes of keys
    /// ([`JobRequest::set`]) it is left out.
    #[must_use]
    pub fn effects(&self) -> Vec<(&CameraPlan, Vec<PlannedEffect>)> {
        self.plan.cameras.iter().map(|camera| (camera, self.plan.effects(camera))).collect()
    }

    /// What the request supersedes of the job file, a sentence each.
    #[must_use]
    pub fn notices(&self) -> &[String] {
        &self.plan.notices
    }

    /// The files that were read: the job and all that it names, by the paths that they were read by. What a program made in memory is not among
    /// them.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The names of all files of a whole run, relative to its output folder.
    #[must_use]
    pub fn file_names(&self, frames: &Range<u32>) -> Vec<String> {
        file_names(&self.plan, frames)
    }

    /// Renders all cameras and keeps their light. For many large cameras [`render_each`](Self::render_each) holds one at a time.
    /// Runs on the caller's thread pool.
    ///
    /// # Errors
    /// Where the observer cancels, or light is not finite.
    pub fn render(&self, options: &RenderOptions, observer: &dyn Observer) -> Result<Results, Error> {
        let mut cameras = Vec::new();
        self.render_each(options, observer, |camera| {
            cameras.push(camera);
            Ok(())
        })?;
        Ok(Results::new(cameras))
    }

    /// Renders camera after camera and hands each one's results over; cameras of equal light are rendered once and follow one another. Runs
    /// on the caller's thread pool.
    ///
    /// # Errors
    /// Where the observer cancels, light is not finite, or `take` fails.
    pub fn render_each(
        &self,
        options: &RenderOptions,
        observer: &dyn Observer,
        mut take: impl FnMut(CameraResults) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let progress = RefCell::new(Progress::default());
        self.deliver(options, |_| Ok(DoneFrames::default()), &progress, observer, &mut take)
    }

    /// The results of all cameras. `done` are the frames that an earlier run of the plan has written, which is the job's, with the passes that
    /// were done where a time decides them.
    fn deliver(
        &self,
        options: &RenderOptions,
        done: impl FnOnce(&Arc<Plan>) -> Result<DoneFrames, Error>,
        progress: &RefCell<Progress>,
        observer: &dyn Observer,
        take: impl FnMut(CameraResults) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.warn(observer);
        self.check_memory(&options.frames)?;
        if let Some(total_s) = self.request.time_s {
            check_frames(&self.plan, &options.frames)?;
            let mut light = timed::light(&self.plan, total_s, options, observer, &mut progress.borrow_mut())?;
            let plan = Arc::clone(&light.plan);
            return deliver(&plan, options, &done(&plan)?, |group, shot, _| light.take(group[0], shot), take);
        }
        let (plan, done) = (&self.plan, done(&self.plan)?);
        let films = films_of(plan, &options.frames, &done);
        let mut exposures = Exposures::new((plan, &options.frames), films, (Shard::WHOLE, options.simd), observer);
        let film_of = |group: &[&CameraPlan], shot, so_far: SoFar<'_>| {
            let camera = group[0];
            let kept = progress.borrow().kept(plan, camera, shot)?;
            let kept = kept.map(|kept| (kept.film, kept.passes.list().len()));
            exposures.film((group, shot), kept, |film, passes| {
                let mut progress = progress.borrow_mut();
                let done = Passes::new((0..passes).map(|number| camera.pass(number).pass).collect());
                progress.keep(plan, (camera, shot), film, (&done, camera.settings.replicates, 0.0))?;
                match passes < camera.pass_count() {
                    true => progress.refine(plan, (group, shot), film, so_far, options),
                    false => Ok(()),
                }
            })
        };
        deliver(plan, options, &done, film_of, take)
    }

    /// Renders camera after camera, where light depends on time frame after frame, and writes each one's files before the next is
    /// rendered; answers with the paths of what it wrote. Files get their names when all are complete, those of a frame that has a light of its
    /// own when that frame is: a run that is interrupted keeps them, and one that resumes goes on after them. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// Where the observer cancels, light is not finite, or the folder cannot be written.
    pub fn save(
        &self,
        options: &RenderOptions,
        (folder, existing): (&Path, Existing),
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        let root = folder;
        let done = |plan: &Arc<Plan>| match existing {
            Existing::Resume => DoneFrames::in_folder(root, plan, &options.frames, observer),
            Existing::Refuse | Existing::Replace => Ok(DoneFrames::default()),
        };
        let folder = OutputFolder::open(root, existing).map_err(Error::input)?;
        // Where a time decides the passes, the plan of the frames is known when they are done.
        let mut known = self.request.time_s.is_none().then(|| done(&self.plan)).transpose()?;
        state::check(&folder, existing)?;
        folder.claim(self.file_names(&options.frames).iter().map(String::as_str)).map_err(Error::input)?;
        let mut folder = if self.request.progressive { folder.refining() } else { folder };
        let progress = RefCell::new(Progress::of(self.request.progressive, (&folder, existing))?);
        let kept = Kept::of_run(&folder, observer);
        let (sequence, mut written) = (RefCell::new(Sequence::default()), Vec::new());
        let done_and_noted = |plan: &Arc<Plan>| {
            let done = known.take().map_or_else(|| done(plan), Ok)?;
            done.note_all(plan, &options.frames, &mut sequence.borrow_mut());
            Ok(done)
        };
        self.deliver(options, done_and_noted, &progress, observer, |camera| {
            sequence.borrow_mut().write(&camera, &mut folder, observer)?;
            if camera.has_own_light() {
                written.extend(folder.publish().map_err(Error::run)?);
                kept.frame();
                progress.borrow().forget(camera.camera(), camera.frame_numbers().start)?;
            }
            Ok(())
        })?;
        let sequence = sequence.into_inner();
        sequence.finish(&mut folder, observer)?;
        rig::write(&rig::asked_files(&self.plan, &options.frames), &mut folder, observer)?;
        written.extend(folder.publish().map_err(Error::run)?);
        progress.into_inner().finish(&folder)?;
        kept.all();
        Ok(written)
    }

    /// Writes where all cameras stand and how they project, over frames, in the files of ROS, Kalibr and COLMAP; answers with their paths. Nothing is
    /// rendered.
    ///
    /// # Errors
    /// Where frames have no times, or the folder cannot be written.
    pub fn save_calibration_files(
        &self,
        frames: &Range<u32>,
        (folder, existing): (&Path, Existing),
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        check_frames(&self.plan, frames)?;
        let rig = rig::all_files(&self.plan, frames);
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        folder.claim(rig.files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
        rig::write(&rig, &mut folder, observer)?;
        folder.commit().map_err(Error::run)
    }

    pub(crate) fn shared_plan(&self) -> &Arc<Plan> {
        &self.plan
    }

    pub(crate) fn warn(&self, observer: &dyn Observer) {
        self.plan.warnings().iter().for_each(|warning| observer.message(Message::Warning(warning)));
    }
}
