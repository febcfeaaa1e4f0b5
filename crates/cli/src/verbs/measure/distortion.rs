//! `etendue measure distortion`.

use super::chart_points::ChartPointsArgs;
use super::report::{CameraOut, ReportArgs};
use crate::args::words::place;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, DistortionRequest};
use std::path::PathBuf;

/// `etendue measure distortion`
#[derive(Debug, Args)]
pub struct DistortionArgs {
    /// A picture of a plane chart that fills the field: many dots, or a checkerboard; or a list of its points (CSV: column, row, x_px, y_px)
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub chart: ChartPointsArgs,
    /// The point to which distances are taken, raster coordinates, px [default: the picture's middle]
    #[arg(long, value_name = "X,Y", value_parser = place)]
    pub centre_px: Option<[f64; 2]>,
    #[command(flatten)]
    pub report: ReportArgs,
    #[command(flatten)]
    pub out: CameraOut,
}

impl DistortionArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let report = measure::distortion(&self.into())?;
        self.out.write(&report)?;
        self.report.show(console, &report)
    }
}

impl From<&DistortionArgs> for DistortionRequest {
    fn from(a: &DistortionArgs) -> Self {
        Self { file: a.file.clone(), chart: (&a.chart).into(), centre_px: a.centre_px }
    }
}
