//! `etendue datasheet`: a camera file from an EMVA 1288 data sheet.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::Error;
use std::path::PathBuf;

/// `etendue datasheet`
#[derive(Debug, Args)]
pub struct DataSheet {
    /// Values of the data sheet (TOML; docs/format/datasheet.md has the keys)
    #[arg(value_name = "SHEET.toml")]
    pub sheet: PathBuf,
    #[command(flatten)]
    pub output: Output,
}

impl DataSheet {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || {
            etendue::datasheet(&self.sheet, self.output.path(), self.output.existing(), console.observer())
        })
    }
}
