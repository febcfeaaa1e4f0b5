//! `etendue laboratory`: a laboratory folder, captured by a camera file.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, LaboratoryRequest, laboratory};

/// `etendue laboratory`
#[derive(Debug, Args)]
pub struct Laboratory {
    #[command(flatten)]
    pub request: LaboratoryRequest,
    #[command(flatten)]
    pub output: Output,
}

impl Laboratory {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || {
            laboratory(&self.request, self.output.path(), self.output.existing(), console.observer())
        })
    }
}
