//! `etendue measure flicker`.

use super::picture::PictureArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, FlickerRequest};
use std::path::PathBuf;

/// `etendue measure flicker`
#[derive(Debug, Args)]
pub struct FlickerArgs {
    /// Frames of a sequence in their order, or one of a rolling shutter
    #[arg(value_name = "FRAME", required = true)]
    pub frames: Vec<PathBuf>,
    /// Time from one row of the file to the next, µs, of a rolling shutter [default: the side-car's, or all rows are exposed together]
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    pub row_time_us: Option<f64>,
    /// Frames a second [default: the side-car's, or not known; each frame is measured by itself]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub frame_rate_hz: Option<f64>,
    /// Exposure of a row, µs: tells the light's own modulation and the duty of its pulses [default: the side-car's, or not known]
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    pub exposure_us: Option<f64>,
    #[command(flatten)]
    pub input: PictureArgs,
}

impl FlickerArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.input.report.show(console, &measure::flicker(&self.into())?)
    }
}

impl From<&FlickerArgs> for FlickerRequest {
    fn from(a: &FlickerArgs) -> Self {
        let FlickerArgs { row_time_us, frame_rate_hz, exposure_us, .. } = *a;
        Self { frames: a.frames.clone(), row_time_us, frame_rate_hz, exposure_us, input: (&a.input).into() }
    }
}
