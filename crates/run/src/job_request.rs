//! A job file with changes, and the selection of frames.

use crate::memory_limits::{FilmMemory, MemoryLimits};
use clap::Args;
use etendue_arguments::{frames, word};
use etendue_core::{Integrator, Quality, Word as _};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{CacheUse, Sandbox, TextureMemory};
use etendue_pipeline::{Choices, Plan, Refinement};
use etendue_scene::Overrides;
use etendue_tracer::accel::Simd;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Minimum time of a run of a given time, s.
const MIN_TIME_S: f64 = 10.0;

/// Folder of texture tiles in an output folder; not a legal camera name.
const TILE_FOLDER: &str = ".texture-cache";

/// A job file with its changes: sufficient to make the same plan again.
#[derive(Args, Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobRequest {
    /// The job file (TOML)
    #[arg(value_name = "JOB.toml")]
    pub job: PathBuf,
    /// Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Samples per pixel, over all replicates, of every camera [default: that of the job or of the quality]
    #[arg(long, value_name = "N")]
    pub spp: Option<u64>,
    /// Sample each pixel until its standard error is F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp
    /// samples
    #[arg(long, value_name = "F", conflicts_with = "spp")]
    pub noise: Option<f64>,
    /// Rendering time, s, 10 or more, of all cameras and frames together, from the first sample on, by the observer's clock; `None`: as the job states.
    #[arg(skip)]
    pub time_s: Option<f64>,
    /// If true, rendering is progressive: passes double where neither the job nor a time states others; the saved results are refined after each pass and can
    /// be resumed.
    #[arg(skip)]
    pub progressive: bool,
    /// Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and mean level, with one pixel instead of
    /// K × K; sets sensor.scale of all cameras
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[arg(long, value_name = "1/K")]
    pub scale: Option<String>,
    /// Light paths that every camera simulates, as in render.integrator [default: the job's, or path]
    #[arg(long, value_parser = word::<Integrator>())]
    pub integrator: Option<Integrator>,
    /// Preset of samples and bounces, for keys that the job file leaves open
    #[arg(long, value_parser = word::<Quality>())]
    pub quality: Option<Quality>,
    /// Render only this camera of the job
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Seed of all random numbers [default: the job's, or 0]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Folders, in addition to the job's own, that its files may lie in, whatever names them: the job, a base, a scene, a camera, a material library, a lamp
    /// or a change. `None`: files may lie anywhere. A shard stores it for `merge`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[arg(skip)]
    pub sandbox: Option<Vec<PathBuf>>,
    /// Memory limit of textures, and the place of those that exceed it. A property of the machine, not of the plan: files that state a request omit it.
    #[serde(skip)]
    #[arg(skip)]
    pub textures: TextureMemory,
    /// Memory limit of films, and the place of those that exceed it. A property of the machine as well.
    #[serde(skip)]
    #[arg(skip)]
    pub films: FilmMemory,
    /// Free memory for the run; a run that needs more is refused. A property of the machine as well; by default no limit is known.
    #[serde(skip)]
    #[arg(skip)]
    pub memory: MemoryLimits,
}

/// Selection of frames, and how they are rendered: options that do not change the light.
#[derive(Args, Clone, Debug, Eq, PartialEq)]
pub struct RenderOptions {
    /// Frames to take, first to last (the last excluded); each has its own sensor noise. Time-independent light is rendered once
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: Range<u32>,
    /// Instruction set of the accelerator. The result does not depend on it.
    #[arg(skip)]
    pub simd: Simd,
}

impl Default for RenderOptions {
    /// Frame 0, with the best instruction set of the processor.
    fn default() -> Self {
        Self { frames: 0..1, simd: Simd::Auto }
    }
}

impl JobRequest {
    /// A job file without changes.
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

    /// Sets the output folder. The texture tiles of a sandboxed job that names no folder for them are there, in `.texture-cache`.
    #[must_use]
    pub fn into_output(mut self, folder: &Path) -> Self {
        if self.sandbox.is_some() && self.textures.cache.is_none() {
            self.textures.cache = Some(folder.join(TILE_FOLDER));
            self.textures.cache_use = CacheUse::KeepInOutput;
        }
        self
    }

    /// Returns the memory limit of textures. A sandboxed job without a folder for tiles and without an output folder keeps all textures in memory: it writes
    /// nothing outside its permitted folders.
    pub(crate) fn texture_memory(&self) -> TextureMemory {
        let has_no_folder =
            self.sandbox.is_some() && self.textures.cache.is_none() && self.textures.cache_use == CacheUse::Keep;
        let limit_bytes = if has_no_folder { u64::MAX } else { self.textures.limit_bytes };
        TextureMemory { limit_bytes, ..self.textures.clone() }
    }

    /// Disables texture tiles on disk: for reports on a job that is not rendered.
    #[must_use]
    pub fn without_tiles(mut self) -> Self {
        self.textures.cache_use = CacheUse::Read;
        self
    }

    /// Folders in which the files of the job may lie.
    pub(crate) fn folders(&self) -> Result<Sandbox, Error> {
        let Some(further) = &self.sandbox else { return Ok(Sandbox::NONE) };
        Sandbox::for_job(&self.job, further)
    }

    /// Refuses options that exclude one another, and a time that is too short.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.textures.limit_bytes == 0 {
            return Err(Error::argument(
                "texture_memory_mb",
                "`texture_memory_mb` 0: textures need some memory; give 1 MB or more",
            )
            .with_code(ErrorCode::OutOfRange));
        }
        let Some(time_s) = self.time_s else { return Ok(()) };
        if !(time_s.is_finite() && time_s >= MIN_TIME_S) {
            return Err(Error::argument(
                "time_s",
                format!(
                    "`time_s` {time_s}: the time must be {MIN_TIME_S} s or more; give `time_s` {MIN_TIME_S}, or samples with `spp`"
                ),
            ).with_code(ErrorCode::OutOfRange));
        }
        match (self.spp, self.noise) {
            (None, None) => Ok(()),
            _ => Err(Error::argument(
                "time_s",
                "`time_s` excludes `spp` and `noise`, which also determine the samples; give one of them",
            )
            .with_code(ErrorCode::Contradiction)),
        }
    }

    /// The changes to the description; options are checked in the same way as their keys.
    pub(crate) fn overrides(&self) -> Overrides {
        let mut overrides = Overrides::new(&self.set);
        let mut flag = |name: &str, key, value: String, spelling: &str| {
            overrides.add_render(&format!("`{name}` {spelling}"), key, &value);
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
            let word = integrator.word();
            flag("integrator", "integrator", format!("\"{word}\""), word);
        }
        if let Some(scale) = &self.scale {
            overrides.push_sensor(&format!("`scale` {scale}"), "scale", scale);
        }
        overrides
    }

    pub(crate) fn choices(&self) -> Choices {
        let refinement = match (self.time_s, self.progressive) {
            (Some(_), _) => Refinement::Timed,
            (None, true) => Refinement::Progressive,
            (None, false) => Refinement::Described,
        };
        Choices { quality: self.quality, refinement }
    }

    /// Restricts the plan to the requested camera. Its random addresses remain those among all cameras.
    pub(crate) fn narrowed(&self, mut plan: Plan) -> Result<Plan, Error> {
        let Some(name) = &self.camera else { return Ok(plan) };
        if plan.camera(name).is_none() {
            let known: Vec<&str> = plan.cameras.iter().map(|c| c.name.as_str()).collect();
            return Err(Error::argument(
                "camera",
                format!(
                    "`camera` {name}: {} has no camera of this name; give one of {}",
                    self.job.display(),
                    known.join(", ")
                ),
            )
            .with_code(ErrorCode::UnknownName));
        }
        let right = plan.camera(name).and_then(|camera| camera.products.annotations.disparity).map(|d| d.right);
        if let Some(right) = plan.cameras.iter().find(|camera| Some(camera.index) == right) {
            return Err(Error::argument(
                "camera",
                format!(
                    "`camera` {name}: its disparity_to refers to camera {}, which is not in this run; render both, or remove the key with `set`",
                    right.name
                ),
            ).with_code(ErrorCode::Contradiction));
        }
        plan.cameras.retain(|camera| camera.name == *name);
        Ok(plan)
    }
}
