//! The job of `render` and `plan`.

use crate::console::Console;
use crate::memory;
use clap::Args;
use etendue::{Error, FilmMemory, Job, JobRequest, Message, TextureMemory};
use etendue_arguments::whole;
use std::path::PathBuf;

/// A job file and what the command line changes in it.
#[derive(Debug, Args)]
pub struct JobArgs {
    #[command(flatten)]
    pub request: JobRequest,
    /// Refuse every file outside the folder of the job, whoever names it and through whatever link: for the jobs of others (docs/limits.md)
    #[arg(long)]
    pub sandboxed: bool,
    /// With --sandboxed: files may lie in this folder, too
    #[arg(long, value_name = "DIR", requires = "sandboxed")]
    pub allow_outside: Vec<PathBuf>,
    /// Memory of textures. Where they need more, the large ones are kept in tiles on the disk and read where they are looked up. The result
    /// does not depend on it
    #[arg(id = "texture_memory_mb", long = "texture-memory", value_name = "MB", value_parser = whole(1..=1 << 20), default_value = "512")]
    pub texture_memory: u32,
    /// The folder of these tiles, which another run finds again [default: etendue in $XDG_CACHE_HOME, else in ~/.cache]
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Memory of the bands of one film: their means and variances, 8 bytes a pixel and band. Larger ones are kept in a scratch file on the disk, and
    /// files, effects and electrons are made of it some rows or one band at a time. The result does not depend on it
    #[arg(id = "film_memory_mb", long = "film-memory", value_name = "MB", value_parser = whole(1..=1 << 20), default_value = "2048")]
    pub film_memory: u32,
    /// Memory that the run may take, beside the program; a run whose estimate is higher is refused before its first sample. 0: no check [default: what
    /// the process, its control group and the machine have free]
    #[arg(id = "memory_mb", long = "memory", value_name = "MB", value_parser = whole(0..=1 << 24))]
    pub memory: Option<u32>,
    /// The folder of these scratch files, which are gone when the run ends [default: that of --cache]
    #[arg(long, value_name = "DIR")]
    pub scratch: Option<PathBuf>,
}

impl JobArgs {
    /// The request with the folders and the memory of this machine.
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

    /// Opens the job to describe it, and notes what the command line supersedes.
    pub fn open(&self, console: &dyn Console, pool: &rayon::ThreadPool) -> Result<Job, Error> {
        Self::open_request(console, self.request().without_tiles(), pool)
    }

    /// The same of a request, for a run.
    pub fn open_request(console: &dyn Console, request: JobRequest, pool: &rayon::ThreadPool) -> Result<Job, Error> {
        let job = pool.install(|| request.open())?;
        job.notices().iter().for_each(|notice| console.observer().message(Message::Note(notice)));
        Ok(job)
    }
}
