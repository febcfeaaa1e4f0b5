//! `etendue import`: a scene of another program as files of the format.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, ImportRequest};
use std::path::PathBuf;

/// `etendue import`
#[derive(Debug, Args)]
pub struct Import {
    /// The scene: glTF 2.0 (.glb, .gltf), pbrt-v4 (.pbrt), Mitsuba 3 (.xml), USD (.usd, .usda, .usdc, .usdz) where it is built in
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Give a value to a parameter of a Mitsuba scene ($name) in place of its default, e.g. -D radius=0.5
    #[arg(short = 'D', long, value_name = "NAME=VALUE", value_parser = parameter)]
    pub define: Vec<(String, String)>,
    #[command(flatten)]
    pub output: Output,
}

impl Import {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let request = ImportRequest { file: self.scene.clone(), parameters: self.define.clone() };
        print_written(console, || etendue::import(&request, self.output.folder(), console.observer()))
    }
}

/// `NAME=VALUE`, as Mitsuba's own option.
fn parameter(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE, such as radius=0.5".to_owned()),
    }
}
