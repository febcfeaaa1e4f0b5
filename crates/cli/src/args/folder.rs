//! The folder for results.

use clap::Args;
use etendue::Existing;
use std::path::{Path, PathBuf};

/// Where results go.
#[derive(Debug, Args)]
pub struct Output {
    /// Folder for the results; made where missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Replace results that are already there
    #[arg(long)]
    pub overwrite: bool,
}

impl Output {
    /// The folder, and whether results there may be replaced.
    pub fn folder(&self) -> (&Path, Existing) {
        (&self.output, if self.overwrite { Existing::Replace } else { Existing::Refuse })
    }
}
