//! `etendue laboratory`: a laboratory folder, photographed by a camera file.

use crate::args::folder::Output;
use crate::args::run::{seed, whole};
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, LaboratoryRequest, laboratory};
use std::path::PathBuf;

/// `etendue laboratory`
#[derive(Debug, Args)]
pub struct Laboratory {
    /// The camera file (TOML)
    #[arg(value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set sensor.width_px=320
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The seed of all noise
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    pub seed: u64,
    /// Levels of even light on the bare sensor, up to a little above saturation
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = whole(5, 1000))]
    pub levels: u32,
    /// Frames of the stacks without light and at half of saturation
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = whole(3, 10_000))]
    pub stack: u32,
    /// Views of the checkerboard
    #[arg(long, value_name = "N", default_value_t = 13, value_parser = whole(3, 200))]
    pub views: u32,
    /// Samples a pixel of the pictures through the lens
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = whole(1, 65_536))]
    pub spp: u32,
    #[command(flatten)]
    pub output: Output,
}

impl Laboratory {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || laboratory(&self.into(), self.output.folder(), console.observer()))
    }
}

impl From<&Laboratory> for LaboratoryRequest {
    fn from(a: &Laboratory) -> Self {
        let (camera, set) = (a.camera.clone(), a.set.clone());
        Self { camera, set, seed: a.seed, levels: a.levels, stack: a.stack, views: a.views, spp: a.spp }
    }
}
