//! `etendue measure noise`.

use super::picture::PictureArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, NoiseRequest};
use std::path::PathBuf;

/// `etendue measure noise`
#[derive(Debug, Args)]
pub struct NoiseArgs {
    /// Eight or more frames of one even surface, or of a chart with --truth
    #[arg(value_name = "FRAME", required = true)]
    pub frames: Vec<PathBuf>,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl NoiseArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::noise(&self.into())?)
    }
}

impl From<&NoiseArgs> for NoiseRequest {
    fn from(a: &NoiseArgs) -> Self {
        Self { frames: a.frames.clone(), input: (&a.input).into() }
    }
}
