//! `etendue measure oecf`.

use super::picture::PictureArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, OecfRequest};
use std::path::PathBuf;

/// `etendue measure oecf`
#[derive(Debug, Args)]
pub struct OecfArgs {
    /// Pictures of one even surface, one an exposure; with --steps, or the --truth of a chart of steps, one picture
    #[arg(value_name = "PICTURE", required = true)]
    pub pictures: Vec<PathBuf>,
    /// Exposure of each picture in their order, any unit [default: the side-cars' exposure_s]
    #[arg(long, value_name = "H,…", value_delimiter = ',', conflicts_with_all = ["steps", "truth"], allow_negative_numbers = true)]
    pub exposures: Vec<f64>,
    /// A table of steps in the picture: x, y, width, height, luminance; one step a line, # for comments
    #[arg(long, value_name = "STEPS.csv", conflicts_with = "truth")]
    pub steps: Option<PathBuf>,
    /// Find the camera's response from pictures of one scene (not even) at exposures known relatively
    #[arg(long, conflicts_with_all = ["steps", "truth"])]
    pub response: bool,
    /// With --response: find the ratios of the exposures too
    #[arg(long, requires = "response")]
    pub refine: bool,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl OecfArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::oecf(&self.into())?)
    }
}

impl From<&OecfArgs> for OecfRequest {
    fn from(a: &OecfArgs) -> Self {
        Self {
            pictures: a.pictures.clone(),
            exposures: a.exposures.clone(),
            steps: a.steps.clone(),
            response: a.response,
            refine: a.refine,
            input: (&a.input).into(),
        }
    }
}
