//! `etendue measure colour`.

use super::picture::PictureArgs;
use crate::args::words::corner;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, ColourRequest};
use glam::DVec2;
use std::path::PathBuf;

/// `etendue measure colour`
#[derive(Debug, Args)]
pub struct ColourArgs {
    /// A picture of a ColorChecker of 24 patches, in colour
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// Middles of the four corner patches, raster coordinates, in the chart's order: dark skin, bluish green, black, white
    #[arg(long, value_name = "X,Y", num_args = 4, value_parser = corner, required_unless_present = "truth", conflicts_with = "truth")]
    pub corners: Vec<DVec2>,
    /// Side of the squares that are read, of the distance of patches
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, conflicts_with = "truth", allow_negative_numbers = true)]
    pub patch: f64,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl ColourArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::colour(&self.into())?)
    }
}

impl From<&ColourArgs> for ColourRequest {
    fn from(a: &ColourArgs) -> Self {
        Self { picture: a.picture.clone(), corners: a.corners.clone(), patch: a.patch, input: (&a.input).into() }
    }
}
