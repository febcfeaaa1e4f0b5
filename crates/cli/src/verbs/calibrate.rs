//! `etendue calibrate`: a camera's intrinsics and distortion from images of a chart.

use super::measure::report::{CameraOut, ReportArgs};
use crate::console::Console;
use crate::machine;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, CalibrationRequest};
use etendue_arguments::toml;
use std::path::PathBuf;

/// `etendue calibrate`
#[derive(Debug, Args)]
pub struct CalibrateArgs {
    #[command(flatten)]
    pub request: CalibrationRequest,
    /// Write the camera file here; needs --pixel-pitch-um
    #[arg(id = "camera_keys", short = 'o', long = "output", value_name = "CAMERA.toml", requires = "pixel_pitch_um", value_parser = toml)]
    pub output: Option<PathBuf>,
    /// Replace an existing camera file
    #[arg(long, requires = "camera_keys")]
    pub overwrite: bool,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl CalibrateArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let out = CameraOut { camera_out: self.output.clone(), overwrite: self.overwrite };
        let request = CalibrationRequest { camera_keys: out.camera_out.is_some(), ..self.request.clone() };
        let report = machine::pool(None)?.install(|| measure::calibrate(&request, console.observer()))?;
        out.write(&report)?;
        self.report.show(console, &report)
    }
}
