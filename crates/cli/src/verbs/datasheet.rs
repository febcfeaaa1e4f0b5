//! `etendue datasheet`: a camera file of an EMVA 1288 data sheet.

use crate::args::folder::Output;
use crate::machine::print_written;
use crate::progress::Terminal;
use clap::Args;
use etendue::Error;
use std::path::PathBuf;

/// `etendue datasheet`
#[derive(Debug, Args)]
pub struct DataSheet {
    /// The data sheet's figures (TOML; docs/format/datasheet.md has the keys)
    #[arg(value_name = "SHEET.toml")]
    pub sheet: PathBuf,
    #[command(flatten)]
    pub output: Output,
}

impl DataSheet {
    pub fn run(&self) -> Result<(), Error> {
        print_written(|| etendue::datasheet(&self.sheet, self.output.folder(), &Terminal::default()))
    }
}
