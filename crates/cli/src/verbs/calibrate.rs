//! `etendue calibrate`: a camera's intrinsics and distortion from pictures of a chart.

use super::measure::report::{CameraOut, ReportArgs};
use super::measure::views::ViewsArgs;
use crate::args::file_name::toml;
use crate::args::words::positive;
use crate::console::Console;
use crate::machine;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, CalibrationRequest};
use std::path::PathBuf;

/// `etendue calibrate`
#[derive(Debug, Args)]
pub struct CalibrateArgs {
    #[command(flatten)]
    pub views: ViewsArgs,
    /// Write the camera file here; needs --pixel-pitch-um
    #[arg(short, long, value_name = "CAMERA.toml", requires = "pixel_pitch_um", value_parser = toml)]
    pub output: Option<PathBuf>,
    /// Replace a camera file that is already there
    #[arg(long, requires = "output")]
    pub overwrite: bool,
    /// The lens's f-number, for the camera file [default: 4, which is marked as a stand-in]
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true, requires = "output")]
    pub f_number: Option<f64>,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl CalibrateArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let pool = machine::pool(None)?;
        let report = pool.install(|| measure::calibrate(&self.into(), console.observer()))?;
        let out = CameraOut { camera_out: self.output.clone(), overwrite: self.overwrite };
        out.write(&report)?;
        self.report.show(console, &report)
    }
}

impl From<&CalibrateArgs> for CalibrationRequest {
    fn from(a: &CalibrateArgs) -> Self {
        Self { views: (&a.views).into(), camera_keys: a.output.is_some(), f_number: a.f_number }
    }
}
