//! `etendue merge`: joins the shards of one job to the result of an unsharded run.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::{print_written, simd};
use clap::Args;
use etendue::Error;
use std::path::PathBuf;

/// `etendue merge`
#[derive(Debug, Args)]
pub struct Merge {
    /// Folders of all shards
    #[arg(required = true, value_name = "DIR")]
    pub shards: Vec<PathBuf>,
    /// Path of the job file, if the shards were rendered from another path or machine [default: as stated in the shards]
    #[arg(long, value_name = "JOB.toml")]
    pub job: Option<PathBuf>,
    #[command(flatten)]
    pub output: Output,
}

impl Merge {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let simd = simd()?;
        print_written(console, || {
            etendue::merge(
                &self.shards,
                self.job.as_deref(),
                simd,
                self.output.path(),
                self.output.existing(),
                console.observer(),
            )
        })
    }
}
