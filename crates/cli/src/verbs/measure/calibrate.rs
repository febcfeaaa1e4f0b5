//! `etendue calibrate`: a camera file from several views of a chart.

use super::report::{CameraOut, Report, Telling};
use super::views::{ViewsArguments, positive};
use crate::failure::Failure;
use clap::Args;
use std::path::PathBuf;

/// `etendue calibrate`
#[derive(Debug, Args)]
pub struct CalibrateArguments {
    #[command(flatten)]
    pub views: ViewsArguments,
    /// Write the camera file here; needs --pixel-pitch-um
    #[arg(short, long, value_name = "CAMERA.toml", requires = "pixel_pitch_um", value_parser = crate::named_file::toml)]
    pub output: Option<PathBuf>,
    /// Replace a camera file that is already there
    #[arg(long, requires = "output")]
    pub overwrite: bool,
    /// The lens's f-number, for the camera file [default: 4, which is marked as a stand-in]
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true, requires = "output")]
    pub f_number: Option<f64>,
    #[command(flatten)]
    pub telling: Telling,
}

pub fn run(arguments: &CalibrateArguments) -> Result<(), Failure> {
    let views = &arguments.views;
    let found = views.found(views.options())?;
    let mut report = Report::new("calibrate", "camera from views of a plane chart, least squares of all points");
    found.tell(&mut report, views);
    if let (Some(pitch_um), Some(_)) = (views.pixel_pitch_um, &arguments.output) {
        report.camera(found.camera_file("calibrate", pitch_um, arguments.f_number)?);
    }
    report.tell_with_camera(
        &arguments.telling,
        &CameraOut { camera_out: arguments.output.clone(), overwrite: arguments.overwrite },
    )
}
