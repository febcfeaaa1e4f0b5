//! `etendue merge`: the shards of one job to the result of an unsharded run.

use crate::args::folder::Output;
use crate::machine::{print_written, simd};
use crate::progress::Terminal;
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
    pub fn run(&self) -> Result<(), Error> {
        let simd = simd()?;
        print_written(|| etendue::merge(&self.shards, simd, self.output.folder(), &Terminal::default()))
    }
}
