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
    /// Returns the folder.
    pub fn path(&self) -> &Path {
        &self.output
    }

    /// Returns what becomes of results that are already there.
    pub fn existing(&self) -> Existing {
        if self.overwrite { Existing::Replace } else { Existing::Refuse }
    }
}
