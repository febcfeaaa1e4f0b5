//! `etendue measure cdp`.

use super::picture::PictureArgs;
use crate::args::words::region;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, CdpRequest};
use std::path::PathBuf;

/// `etendue measure cdp`
#[derive(Debug, Args)]
pub struct CdpArgs {
    /// A picture of grey patches
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// The darker patch of a pair: left column, top row, width, height; once a pair
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub darker: Vec<[usize; 4]>,
    /// The brighter patch of a pair, in the same order
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub brighter: Vec<[usize; 4]>,
    /// The scene's Weber contrast of a pair: brighter over darker luminance, less 1; in the same order
    #[arg(
        long,
        value_name = "K",
        required_unless_present = "truth",
        conflicts_with = "truth",
        allow_negative_numbers = true
    )]
    pub contrast: Vec<f64>,
    /// How much a measured contrast may differ from the scene's, share
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, allow_negative_numbers = true)]
    pub tolerance: f64,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl CdpArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::cdp(&self.into())?)
    }
}

impl From<&CdpArgs> for CdpRequest {
    fn from(a: &CdpArgs) -> Self {
        Self {
            picture: a.picture.clone(),
            darker: a.darker.clone(),
            brighter: a.brighter.clone(),
            contrast: a.contrast.clone(),
            tolerance: a.tolerance,
            input: (&a.input).into(),
        }
    }
}
