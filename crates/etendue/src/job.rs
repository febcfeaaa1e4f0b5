//! From a job file and what changes it to a plan, and from a plan to results.

use crate::error::Error;
use crate::memory::MemoryFiles;
use crate::observer::{Message, Observer, Tiles};
use crate::render_options::RenderOptions;
use crate::results::{CameraResults, Results, file_names};
use crate::shard_spec::ShardSpec;
use etendue_io::{Existing, OutputFolder, complete_assets};
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::{Request, light};
use etendue_pipeline::summary::Summary;
use etendue_pipeline::tile::Shard;
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::{Description, Overrides};
use etendue_tracer::accel::Simd;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How much of the light transport is followed: the key `render.integrator`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Local shading by lamps, suns and sky, without shadows.
    Flat,
    /// The same with shadows.
    Direct,
    /// Everything, by path tracing.
    Path,
}

impl Integrator {
    /// Its word in the key `render.integrator`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Direct => "direct",
            Self::Path => "path",
        }
    }
}

/// Presets of samples and bounces, for what a job file leaves open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// 16 samples a pixel, 4 bounces: to frame and expose.
    Draft,
    /// 64 samples a pixel, 16 bounces.
    Standard,
    /// 1024 samples a pixel, 64 bounces.
    Reference,
}

/// A job file and what is changed in it: enough to make the same plan again.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobRequest {
    /// The job file (TOML).
    pub job: PathBuf,
    /// Changes of its keys, `key=value` as TOML writes the value, e.g. `render.spp=16` or `cameras.front.lens.f_number=4`.
    pub set: Vec<String>,
    /// Samples a pixel, over all replicates, of every camera; `None`: the job's, or the quality's.
    pub spp: Option<u64>,
    /// The integrator of every camera; `None`: the job's, or path.
    pub integrator: Option<Integrator>,
    /// A preset for what the job file leaves open.
    pub quality: Option<Quality>,
    /// The only camera to render, by its name; `None`: all of them.
    pub camera: Option<String>,
    /// The seed of all random numbers, at most 2⁶³ − 1; `None`: the job's, or 0.
    pub seed: Option<u64>,
}

impl JobRequest {
    /// A job file as it is.
    pub fn new(job: impl Into<PathBuf>) -> Self {
        Self { job: job.into(), set: Vec::new(), spp: None, integrator: None, quality: None, camera: None, seed: None }
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
        let description = Description::load(&self.job, &|path| files.read(path), &self.overrides());
        let description = description.map_err(|faults| Error::inputs(faults.list()))?;
        let assets = complete_assets(files.assets().clone(), &description.assets()).map_err(Error::inputs)?;
        let plan = compile(&description, &assets, &self.choices()).map_err(Error::inputs)?;
        let plan = Arc::new(self.narrowed(plan)?);
        Ok(Job { request: self, plan })
    }

    /// The changes to the description: what is asked for goes through the same check as its key.
    fn overrides(&self) -> Overrides {
        let mut overrides = Overrides::new(&self.set);
        let mut flag = |name: &str, key, value: String, shown: &str| {
            overrides.push_render(&format!("--{name} {shown}"), key, &value);
        };
        if let Some(spp) = self.spp {
            flag("spp", "spp", spp.to_string(), &spp.to_string());
        }
        if let Some(seed) = self.seed {
            flag("seed", "seed", seed.to_string(), &seed.to_string());
        }
        if let Some(integrator) = self.integrator {
            let level = integrator.name();
            flag("integrator", "integrator", format!("\"{level}\""), level);
        }
        overrides
    }

    fn choices(&self) -> Choices {
        let quality = self.quality.map(|quality| match quality {
            Quality::Draft => etendue_pipeline::Quality::Draft,
            Quality::Standard => etendue_pipeline::Quality::Standard,
            Quality::Reference => etendue_pipeline::Quality::Reference,
        });
        Choices { quality }
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
        plan.cameras.retain(|camera| camera.name == *name);
        Ok(plan)
    }
}

/// A job that was read, checked and compiled: nothing after it fails because of what its user wrote.
#[derive(Clone, Debug)]
pub struct Job {
    request: JobRequest,
    plan: Arc<Plan>,
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

    /// What the request supersedes of the job file, a sentence each.
    #[must_use]
    pub fn notices(&self) -> &[String] {
        &self.plan.notices
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
        self.warn(observer);
        for group in self.plan.by_light() {
            let film = exposed(&self.plan, &group, Request { simd: options.simd, shard: Shard::WHOLE }, observer)?;
            deliver(&self.plan, &group, film, options, &mut take)?;
        }
        Ok(())
    }

    /// Renders camera after camera and writes each one's files before the next is rendered; answers with their paths. Runs on the caller's
    /// thread pool.
    ///
    /// # Errors
    /// Where the observer cancels, light is not finite, or the folder cannot be written.
    pub fn save(
        &self,
        options: &RenderOptions,
        (folder, existing): (&Path, Existing),
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, Error> {
        let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
        folder.claim(self.file_names(&options.frames).iter().map(String::as_str)).map_err(Error::input)?;
        self.render_each(options, observer, |camera| camera.write(&mut folder, observer))?;
        folder.commit().map_err(Error::run)
    }

    /// Renders the tiles of one shard: a film for each group of cameras of equal light, with the first of these.
    pub(crate) fn render_shard(
        &self,
        spec: ShardSpec,
        simd: Simd,
        observer: &dyn Observer,
        mut take: impl FnMut(&CameraPlan, Film) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.warn(observer);
        let shard = spec.shard()?;
        for group in self.plan.by_light() {
            let film = exposed(&self.plan, &group, Request { simd, shard }, observer)?;
            check_finite(group[0], &film)?;
            take(group[0], film)?;
        }
        Ok(())
    }

    pub(crate) fn shared_plan(&self) -> &Arc<Plan> {
        &self.plan
    }

    fn warn(&self, observer: &dyn Observer) {
        self.plan.warnings().iter().for_each(|warning| observer.message(Message::Warning(warning)));
    }
}

/// The light of cameras that have the same.
fn exposed(plan: &Plan, group: &[&CameraPlan], request: Request, observer: &dyn Observer) -> Result<Film, Error> {
    let heading = match group.len() {
        1 => group[0].name.clone(),
        n => format!("{} and {} more", group[0].name, n - 1),
    };
    let film = light(plan, group[0], request, &Tiles { heading: &heading, observer });
    film.map_err(|cancelled| Error::Run(cancelled.to_string()))
}

/// Hands over the results of cameras that have the same light.
pub(crate) fn deliver(
    plan: &Arc<Plan>,
    group: &[&CameraPlan],
    film: Film,
    options: &RenderOptions,
    take: &mut impl FnMut(CameraResults) -> Result<(), Error>,
) -> Result<(), Error> {
    let Some((last, others)) = group.split_last() else { return Ok(()) };
    check_finite(last, &film)?;
    for camera in others {
        take(CameraResults::of_film(plan, camera, film.clone(), options)?)?;
    }
    take(CameraResults::of_film(plan, last, film, options)?)
}

/// Refuses a film that holds what is no finite number.
fn check_finite(camera: &CameraPlan, film: &Film) -> Result<(), Error> {
    match film.not_finite_samples() {
        0 => Ok(()),
        count => Err(Error::Run(format!(
            "camera {}: {count} samples of its light were not finite numbers, so nothing is delivered; a light is too bright \
             or too near for 32-bit floats: lower it or move it",
            camera.name
        ))),
    }
}
