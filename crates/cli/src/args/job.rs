//! The job of `render` and `plan`.

use super::choice::{Word, choice};
use super::run::whole;
use crate::console::Console;
use crate::memory;
use clap::Args;
use etendue::{Error, FilmMemory, Integrator, Job, JobRequest, Message, Quality, TextureMemory};
use std::path::PathBuf;

const INTEGRATORS: [Word<Integrator>; 3] = [
    (Integrator::Flat, "flat", "Local shading by lamps, suns and sky, without shadows"),
    (Integrator::Direct, "direct", "The same with shadows"),
    (Integrator::Path, "path", "Everything, by path tracing"),
];

const QUALITIES: [Word<Quality>; 3] = [
    (Quality::Draft, "draft", "16 samples a pixel, 4 bounces: to frame and expose"),
    (Quality::Standard, "standard", "64 samples a pixel, 16 bounces"),
    (Quality::Reference, "reference", "1024 samples a pixel, 64 bounces"),
];

/// A job file and what the command line changes in it.
#[derive(Debug, Args)]
pub struct JobArgs {
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
    /// Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and the same mean level, with one
    /// pixel in the place of K × K; it sets sensor.scale of all cameras
    #[arg(long, value_name = "1/K")]
    pub scale: Option<String>,
    /// How much of the light's ways every camera follows, as render.integrator says it [default: the job's, or path]
    #[arg(long, value_parser = choice(INTEGRATORS))]
    pub integrator: Option<Integrator>,
    /// A preset of samples and bounces, for what the job file leaves open
    #[arg(long, value_parser = choice(QUALITIES))]
    pub quality: Option<Quality>,
    /// Render only this camera of the job
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// The seed of all random numbers [default: the job's, or 0]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Refuse every file outside the folder of the job, whoever names it and through whatever link: for the jobs of others (docs/limits.md)
    #[arg(long)]
    pub sandboxed: bool,
    /// With --sandboxed: files may lie in this folder, too
    #[arg(long, value_name = "DIR", requires = "sandboxed")]
    pub allow_outside: Vec<PathBuf>,
    /// Memory of textures. Where they need more, the large ones are kept in tiles on the disk and read where they are looked up. The result
    /// does not depend on it
    #[arg(long, value_name = "MB", value_parser = whole(1, 1 << 20), default_value = "512")]
    pub texture_memory: u32,
    /// The folder of these tiles, which another run finds again [default: etendue in $XDG_CACHE_HOME, else in ~/.cache]
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Memory of the bands of one film: their means and variances, 8 bytes a pixel and band. Larger ones are kept in a scratch file on the disk, and
    /// files, effects and electrons are made of it some rows or one band at a time. The result does not depend on it
    #[arg(long, value_name = "MB", value_parser = whole(1, 1 << 20), default_value = "2048")]
    pub film_memory: u32,
    /// Memory that the run may take, beside the program; a run whose estimate is higher is refused before its first sample. 0: no check [default: what
    /// the process, its control group and the machine have free]
    #[arg(long, value_name = "MB", value_parser = whole(0, 1 << 24))]
    pub memory: Option<u32>,
    /// The folder of these scratch files, which are gone when the run ends [default: that of --cache]
    #[arg(long, value_name = "DIR")]
    pub scratch: Option<PathBuf>,
}

impl From<&JobArgs> for JobRequest {
    fn from(a: &JobArgs) -> Self {
        Self {
            job: a.job.clone(),
            set: a.set.clone(),
            spp: a.spp,
            noise: a.noise,
            time_s: None,
            progressive: false,
            scale: a.scale.clone(),
            integrator: a.integrator,
            quality: a.quality,
            camera: a.camera.clone(),
            seed: a.seed,
            sandbox: a.sandboxed.then(|| a.allow_outside.clone()),
            textures: TextureMemory {
                limit_bytes: u64::from(a.texture_memory) * 1_000_000,
                cache: a.cache.clone(),
                ..TextureMemory::default()
            },
            films: FilmMemory { limit_bytes: u64::from(a.film_memory) * 1_000_000, scratch: a.scratch.clone() },
            memory: memory::stated_or_free(a.memory),
        }
    }
}

impl JobArgs {
    /// Opens the job to describe it, and notes what the command line supersedes.
    pub fn open(&self, console: &dyn Console, pool: &rayon::ThreadPool) -> Result<Job, Error> {
        Self::open_request(console, JobRequest::from(self).without_tiles(), pool)
    }

    /// The same of a request, for a run.
    pub fn open_request(console: &dyn Console, request: JobRequest, pool: &rayon::ThreadPool) -> Result<Job, Error> {
        let job = pool.install(|| request.open())?;
        job.notices().iter().for_each(|notice| console.observer().message(Message::Note(notice)));
        Ok(job)
    }
}
