//! How a report is printed, and what is written of it.

use crate::args::file_name::{svg, toml};
use clap::Args;
use std::path::PathBuf;

/// How results are printed.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw the curves here; an earlier drawing is replaced
    #[arg(long, value_name = "FILE.svg", value_parser = svg)]
    pub plot: Option<PathBuf>,
}

/// Of measurements of what a camera file states.
#[derive(Debug, Default, Args)]
pub struct CameraOut {
    /// Write what was found as keys of a camera file
    #[arg(long, value_name = "CAMERA.toml", value_parser = toml)]
    pub camera_out: Option<PathBuf>,
    /// Replace a camera file that is already there
    #[arg(long, requires = "camera_out")]
    pub overwrite: bool,
}
