//! The folder of results.

use clap::Args;
use etendue::ExistingFiles;
use std::path::{Path, PathBuf};

/// Folder of the results.
#[derive(Debug, Args)]
pub struct Output {
    /// Folder for the results; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Replace existing results
    #[arg(long)]
    pub overwrite: bool,
}

impl Output {
    /// Returns the folder.
    pub fn path(&self) -> &Path {
        &self.output
    }

    /// Returns the treatment of existing results.
    pub fn existing(&self) -> ExistingFiles {
        if self.overwrite { ExistingFiles::Replace } else { ExistingFiles::Refuse }
    }
}
