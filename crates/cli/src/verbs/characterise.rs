//! `etendue characterise`: a camera file from a laboratory folder.

use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::characterise::{CharacteriseRequest, characterise, claim};
use etendue::{Error, ExistingFiles};
use etendue_arguments::toml;
use std::path::PathBuf;

/// `etendue characterise`
#[derive(Debug, Args)]
pub struct Characterise {
    #[command(flatten)]
    pub request: CharacteriseRequest,
    /// Write the camera file here, and next to it the report under the same stem: .html, .json
    #[arg(short, long, value_name = "CAMERA.toml", value_parser = toml)]
    pub output: PathBuf,
    /// Replace existing files
    #[arg(long)]
    pub overwrite: bool,
}

impl Characterise {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let pool = machine::pool(None)?;
        let existing = if self.overwrite { ExistingFiles::Replace } else { ExistingFiles::Refuse };
        claim(&self.output, existing)?;
        let camera = pool.install(|| characterise(&self.request, console.observer()))?;
        print_paths(console, &camera.save_spelled(&self.output, existing, &|text| console.spelled(text))?);
        Ok(())
    }
}
