//! `etendue import`: a scene of another program as files of the format.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::Error;
use std::path::PathBuf;

/// `etendue import`
#[derive(Debug, Args)]
pub struct Import {
    /// The scene: glTF 2.0 (.glb, .gltf), pbrt-v4 (.pbrt), Mitsuba 3 (.xml), USD (.usd, .usda, .usdc, .usdz) where it is built in
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub output: Output,
}

impl Import {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || etendue::import(&self.scene, self.output.folder(), console.observer()))
    }
}
