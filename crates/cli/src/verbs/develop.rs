//! `etendue develop`: pictures of stored raws, by another processing.

use crate::args::folder::Output;
use crate::args::run::{levels, seed};
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{DevelopRequest, Error, Levels};
use std::path::PathBuf;

/// `etendue develop`
#[derive(Debug, Args)]
pub struct Develop {
    /// Raws (PNG, TIFF, DNG), each with its side-car camera.json beside it
    #[arg(required = true, value_name = "RAW")]
    pub raws: Vec<PathBuf>,
    /// The camera file (TOML) whose sensor took them and whose processing makes the pictures
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set isp.demosaic=malvar
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// For raws without a side-car: digital numbers of no light and of a saturated pixel, e.g. 64..4095
    #[arg(long, value_name = "BLACK..WHITE", value_parser = levels)]
    pub levels: Option<Levels>,
    /// The seed of the paper's noises [default: that of the side-car, or 0]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub output: Output,
}

impl From<&Develop> for DevelopRequest {
    fn from(a: &Develop) -> Self {
        Self { raws: a.raws.clone(), camera: a.camera.clone(), set: a.set.clone(), levels: a.levels, seed: a.seed }
    }
}

impl Develop {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let request = DevelopRequest::from(self);
        print_written(console, || etendue::develop(&request, self.output.folder()))
    }
}
