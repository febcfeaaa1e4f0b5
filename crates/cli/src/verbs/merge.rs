//! `etendue merge`: the shards of one job to the result of an unsharded run.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::{print_written, simd};
use clap::Args;
use etendue::Error;
use std::path::PathBuf;

/// `etendue merge`
#[derive(Debug, Args)]
pub struct Merge {
    /// The folders of all shards
    #[arg(required = true, value_name = "DIR")]
    pub shards: Vec<PathBuf>,
    #[command(flatten)]
    pub output: Output,
}

impl Merge {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let simd = simd()?;
        print_written(console, || etendue::merge(&self.shards, simd, self.output.folder(), console.observer()))
    }
}
