//! `etendue measure lens`.

use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, LensRequest};

/// `etendue measure lens`
#[derive(Debug, Args)]
pub struct LensArgs {
    #[command(flatten)]
    pub request: LensRequest,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

impl LensArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let report = measure::lens(&self.request)?;
        match self.json {
            true => console.print_json(&console.spelled(&format!("{:#}\n", report.json()))),
            false => console.print(&console.spelled(&report.text())),
        }
        Ok(())
    }
}
