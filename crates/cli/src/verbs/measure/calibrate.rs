//! `etendue calibrate`: a camera file from several views of a chart.

use super::report::{Report, Telling};
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
    #[arg(short, long, value_name = "CAMERA.toml", requires = "pixel_pitch_um")]
    pub output: Option<PathBuf>,
    /// The lens's f-number, for the camera file [default: 4, which is marked as a stand-in]
    #[arg(long, value_name = "N", value_parser = positive, requires = "output")]
    pub f_number: Option<f64>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw residuals and projection here
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
}

pub fn run(arguments: &CalibrateArguments) -> Result<(), Failure> {
    let views = &arguments.views;
    let found = views.found(views.options())?;
    let mut report = Report::new("calibrate", "camera from views of a plane chart, least squares of all points");
    found.tell(&mut report, views.pixel_pitch_um);
    if let Some(pitch_um) = views.pixel_pitch_um {
        report.camera(found.camera_file(pitch_um, arguments.f_number));
    }
    let (json, plot, camera_out) = (arguments.json, arguments.plot.clone(), arguments.output.clone());
    report.tell(&Telling { json, plot, camera_out })
}
