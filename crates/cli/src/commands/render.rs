//! `etendue render`, `merge`, `expose` and `develop`: files of radiance, electrons, raws, pictures and ground truth.

use crate::args;
use crate::machine;
use crate::output::{print_message, print_paths};
use crate::progress::Terminal;
use etendue::{DevelopRequest, Error, ExposeRequest, Job, JobRequest, RenderOptions};
use std::path::PathBuf;

pub fn run(arguments: &args::Render) -> Result<(), Error> {
    let simd = machine::simd()?;
    let pool = machine::pool(arguments.threads)?;
    let job = open(&arguments.job, &pool)?;
    let (folder, frames) = (arguments.output.folder(), arguments.frames.clone());
    let observer = Terminal::default();
    let written = pool.install(|| match arguments.shard {
        None => job.save(&RenderOptions { frames, simd }, folder, &observer),
        Some(spec) => job.save_shard(spec, frames, simd, folder, &observer),
    })?;
    print_paths(&written);
    Ok(())
}

/// Opens the job and prints what the command line supersedes of it.
pub fn open(arguments: &args::Job, pool: &rayon::ThreadPool) -> Result<Job, Error> {
    let job = pool.install(|| JobRequest::from(arguments).open())?;
    job.notices().iter().for_each(|notice| print_message(&format!("note: {notice}\n")));
    Ok(job)
}

pub fn merge(arguments: &args::Merge) -> Result<(), Error> {
    let simd = machine::simd()?;
    in_pool(|| etendue::merge(&arguments.shards, simd, arguments.output.folder(), &Terminal::default()))
}

pub fn expose(arguments: &args::Expose) -> Result<(), Error> {
    let request = ExposeRequest::from(arguments);
    in_pool(|| etendue::expose(&request, arguments.output.folder(), &Terminal::default()))
}

pub fn develop(arguments: &args::Develop) -> Result<(), Error> {
    let request = DevelopRequest::from(arguments);
    in_pool(|| etendue::develop(&request, arguments.output.folder()))
}

/// Runs on a thread a processor and prints the files that are written.
pub fn in_pool(task: impl FnOnce() -> Result<Vec<PathBuf>, Error> + Send) -> Result<(), Error> {
    print_paths(&machine::pool(None)?.install(task)?);
    Ok(())
}
