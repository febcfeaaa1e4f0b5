//! `etendue measure flare`.

use super::picture::PictureArgs;
use crate::args::words::region;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, FlareRequest};
use std::path::PathBuf;

/// `etendue measure flare`
#[derive(Debug, Args)]
pub struct FlareArgs {
    /// A picture of light traps in a white field
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// A part of a light trap: left column, top row, width, height; once a trap
    #[arg(long = "trap", value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub traps: Vec<[usize; 4]>,
    /// A part of the white field
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub white: Option<[usize; 4]>,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl FlareArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::flare(&self.into())?)
    }
}

impl From<&FlareArgs> for FlareRequest {
    fn from(a: &FlareArgs) -> Self {
        Self { picture: a.picture.clone(), traps: a.traps.clone(), white: a.white, input: (&a.input).into() }
    }
}
