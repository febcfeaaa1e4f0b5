//! `etendue expose`: a stored radiance image photographed by another lens and sensor.

use crate::args::depth_of_field::depth_of_field;
use crate::args::folder::Output;
use crate::args::run::{frames, seed};
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, ExposeRequest};
use etendue_optics::DepthOfField;
use std::path::PathBuf;

/// `etendue expose`
#[derive(Debug, Args)]
pub struct Expose {
    /// A spectral radiance image rendered with route = "pupil"
    #[arg(value_name = "RADIANCE.exr")]
    pub radiance: PathBuf,
    /// The camera file (TOML) to photograph it with
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The seed of the sensor's noise [default: that of the radiance image]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: std::ops::Range<u32>,
    /// How things out of focus are blurred: physical, none, or a look, e.g.
    /// fast:blur_px=8,near_m=0.5..2,far_m=10..40 [default: physical]
    #[arg(long, value_name = "METHOD", value_parser = depth_of_field)]
    pub depth_of_field: Option<DepthOfField>,
    #[command(flatten)]
    pub output: Output,
}

impl From<&Expose> for ExposeRequest {
    fn from(a: &Expose) -> Self {
        Self {
            radiance: a.radiance.clone(),
            camera: a.camera.clone(),
            set: a.set.clone(),
            seed: a.seed,
            frames: a.frames.clone(),
            depth_of_field: a.depth_of_field,
        }
    }
}

impl Expose {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let request = ExposeRequest::from(self);
        print_written(console, || etendue::expose(&request, self.output.folder(), console.observer()))
    }
}
