//! The job of `render` and `plan`.

use crate::console::Console;
use crate::memory;
use clap::Args;
use etendue::{Error, FilmMemory, Job, JobRequest, Message, TextureMemory};
use etendue_arguments::integer;
use std::path::PathBuf;

/// A job file and its overrides on the command line.
#[derive(Debug, Args)]
pub struct JobArgs {
    #[command(flatten)]
    pub request: JobRequest,
    /// Refuse every file outside the folder of the job, whichever file names it and through any link: for untrusted jobs (docs/limits.md)
    #[arg(long)]
    pub sandboxed: bool,
    /// With --sandboxed: also allow files in this folder
    #[arg(long, value_name = "DIR", requires = "sandboxed")]
    pub allow_outside: Vec<PathBuf>,
    /// Memory of textures. If they need more, large ones are stored as tiles on disk and read on demand. The result does not depend on it
    #[arg(id = "texture_memory_mb", long = "texture-memory", value_name = "MB", value_parser = integer(1..=1 << 20), default_value = "512")]
    pub texture_memory: u32,
    /// Folder of these tiles, reused by later runs [default: etendue in $XDG_CACHE_HOME, else in ~/.cache]
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Memory of the bands of one film: means and variances, 8 bytes per pixel and band. Larger films are stored in a scratch file on disk; files,
    /// effects and electrons are then computed from it some rows or one band at a time. The result does not depend on it
    #[arg(id = "film_memory_mb", long = "film-memory", value_name = "MB", value_parser = integer(1..=1 << 20), default_value = "2048")]
    pub film_memory: u32,
    /// Memory limit of the run, without the program itself; a run with a higher estimate is refused before its first sample. 0: no check [default:
    /// the free memory of the process, its control group and the machine]
    #[arg(id = "memory_mb", long = "memory", value_name = "MB", value_parser = integer(0..=1 << 24))]
    pub memory: Option<u32>,
    /// Folder of these scratch files, which are removed at the end of the run [default: that of --cache]
    #[arg(long, value_name = "DIR")]
    pub scratch: Option<PathBuf>,
}

impl JobArgs {
    /// Returns the request with the folders and the memory of this machine.
    pub fn request(&self) -> JobRequest {
        JobRequest {
            sandbox: self.sandboxed.then(|| self.allow_outside.clone()),
            textures: TextureMemory {
                limit_bytes: u64::from(self.texture_memory) * 1_000_000,
                cache: self.cache.clone(),
                ..TextureMemory::default()
            },
            films: FilmMemory { limit_bytes: u64::from(self.film_memory) * 1_000_000, scratch: self.scratch.clone() },
            memory: memory::stated_or_free(self.memory),
            ..self.request.clone()
        }
    }

    /// Opens the job to describe it, and reports keys overridden by the command line.
    pub fn open(&self, console: &dyn Console, pool: &rayon::ThreadPool) -> Result<Job, Error> {
        Self::open_request(console, self.request().without_tiles(), pool)
    }

    /// Opens the job of a request, for a run.
    pub fn open_request(console: &dyn Console, request: JobRequest, pool: &rayon::ThreadPool) -> Result<Job, Error> {
        let job = pool.install(|| request.open())?;
        job.overridden_settings().iter().for_each(|key| console.observer().message(Message::Note(key)));
        Ok(job)
    }
}
