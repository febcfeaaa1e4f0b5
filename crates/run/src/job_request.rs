//! A job file and what is changed in it, and which of its frames are taken.

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

/// The least time that can be kept, s.
const MIN_TIME_S: f64 = 10.0;

/// The folder of tiles in an output folder, no name of a camera.
const TILES: &str = ".texture-cache";

/// A job file and what is changed in it: enough to make the same plan again.
#[derive(Args, Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobRequest {
    /// The job file (TOML)
    #[arg(value_name = "JOB.toml")]
    pub job: PathBuf,
    /// Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Samples a pixel, over all replicates, of every camera [default: the job's, or the quality's]
    #[arg(long, value_name = "N")]
    pub spp: Option<u64>,
    /// As many samples as each pixel needs for a standard error of F times the noise that its sensor adds (F times its mean without a
    /// sensor), at most render.max_spp
    #[arg(long, value_name = "F", conflicts_with = "spp")]
    pub noise: Option<f64>,
    /// As many samples as this much time of light allows, s, 10 or more: all cameras and frames together, from the first sample on, by the
    /// observer's clock; `None`: as the job says.
    #[arg(skip)]
    pub time_s: Option<f64>,
    /// Whether light comes in passes, by a schedule that doubles where neither the job nor a time says others, and what is saved
    /// is refined and can be resumed after each.
    #[arg(skip)]
    pub progressive: bool,
    /// Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and the same mean level, with one
    /// pixel in the place of K × K; it sets sensor.scale of all cameras
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[arg(long, value_name = "1/K")]
    pub scale: Option<String>,
    /// How much of the light's ways every camera follows, as render.integrator says it [default: the job's, or path]
    #[arg(long, value_parser = word::<Integrator>())]
    pub integrator: Option<Integrator>,
    /// A preset of samples and bounces, for what the job file leaves open
    #[arg(long, value_parser = word::<Quality>())]
    pub quality: Option<Quality>,
    /// Render only this camera of the job
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// The seed of all random numbers [default: the job's, or 0]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Folders beside the job's own that its files may lie in, however they are named: in the job, a base, a scene, a camera, a material library, a lamp or
    /// a change. `None`: files may lie anywhere. A shard keeps it for `merge`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[arg(skip)]
    pub sandbox: Option<Vec<PathBuf>>,
    /// How much memory textures may take, and where those are kept that take more. It belongs to the machine and not to the plan: files that state a
    /// request leave it out.
    #[serde(skip)]
    #[arg(skip)]
    pub textures: TextureMemory,
    /// How much memory films may take, and where those are kept that take more. It belongs to the machine as well.
    #[serde(skip)]
    #[arg(skip)]
    pub films: FilmMemory,
    /// The memory that is free for the run; a run that needs more is refused. It is a property of the machine as well; by default no limit is known.
    #[serde(skip)]
    #[arg(skip)]
    pub memory: MemoryLimits,
}

/// Which frames are taken, and how: what does not change the light.
#[derive(Args, Clone, Debug, Eq, PartialEq)]
pub struct RenderOptions {
    /// Frames to take, first to last (the last excluded); each has its own sensor noise. Light that does not depend on time is
    /// rendered once
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: Range<u32>,
    /// The instruction set of the accelerator. The result does not depend on it.
    #[arg(skip)]
    pub simd: Simd,
}

impl Default for RenderOptions {
    /// Frame 0, by the best instruction set of the processor.
    fn default() -> Self {
        Self { frames: 0..1, simd: Simd::Auto }
    }
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
    pub(crate) fn texture_memory(&self) -> TextureMemory {
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

    /// Where the files of the job may lie.
    pub(crate) fn folders(&self) -> Result<Sandbox, Error> {
        let Some(further) = &self.sandbox else { return Ok(Sandbox::NONE) };
        Sandbox::about(&self.job, further)
    }

    /// Refuses what excludes one another, and a time that cannot be kept.
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
                    "`time_s` {time_s}: a time of {MIN_TIME_S} s or more is kept; give `time_s` {MIN_TIME_S} or samples with `spp`"
                ),
            ).with_code(ErrorCode::OutOfRange));
        }
        match (self.spp, self.noise) {
            (None, None) => Ok(()),
            _ => Err(Error::argument(
                "time_s",
                "`time_s` decides the samples, and `spp` or `noise` would, too; give one of them",
            )
            .with_code(ErrorCode::Contradiction)),
        }
    }

    /// The changes to the description: what is asked for goes through the same check as its key.
    pub(crate) fn overrides(&self) -> Overrides {
        let mut overrides = Overrides::new(&self.set);
        let mut flag = |name: &str, key, value: String, shown: &str| {
            overrides.push_render(&format!("`{name}` {shown}"), key, &value);
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

    /// Only the camera that was asked for. Its random addresses are those it has among all.
    pub(crate) fn narrowed(&self, mut plan: Plan) -> Result<Plan, Error> {
        let Some(name) = &self.camera else { return Ok(plan) };
        if plan.camera(name).is_none() {
            let known: Vec<&str> = plan.cameras.iter().map(|c| c.name.as_str()).collect();
            return Err(Error::argument(
                "camera",
                format!(
                    "`camera` {name}: {} has no camera of that name; give one of {}",
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
                    "`camera` {name}: its disparity_to names camera {}, which is then not in the run; render both, or leave the key out with `set`",
                    right.name
                ),
            ).with_code(ErrorCode::Contradiction));
        }
        plan.cameras.retain(|camera| camera.name == *name);
        Ok(plan)
    }
}
