//! `etendue characterise`: a camera file from a laboratory folder.

use crate::args::file_name::toml;
use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::characterise::{CharacteriseRequest, characterise, claim};
use etendue::{Error, Existing};
use std::path::PathBuf;

/// `etendue characterise`
#[derive(Debug, Args)]
pub struct Characterise {
    /// The laboratory folder: folders dark, flat, field, chart, edges and checker with pictures in them, any of them missing, and laboratory.toml where pictures do not say enough
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Write the camera file here, and beside it the report under the same stem: .html, .json
    #[arg(short, long, value_name = "CAMERA.toml", value_parser = toml)]
    pub output: PathBuf,
    /// Lay the camera file over this one: what is not measured is its
    #[arg(long, value_name = "CAMERA.toml", value_parser = toml)]
    pub base: Option<PathBuf>,
    /// Replace files that are already there
    #[arg(long)]
    pub overwrite: bool,
}

impl Characterise {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let pool = machine::pool(None)?;
        let existing = if self.overwrite { Existing::Replace } else { Existing::Refuse };
        claim(&self.output, existing)?;
        let found = pool.install(|| characterise(&self.into(), console.observer()))?;
        print_paths(console, &found.save(&self.output, existing)?);
        Ok(())
    }
}

impl From<&Characterise> for CharacteriseRequest {
    fn from(a: &Characterise) -> Self {
        Self { folder: a.folder.clone(), base: a.base.clone() }
    }
}
