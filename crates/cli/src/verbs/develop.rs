//! `etendue develop`: images from stored raws, by another processing.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{DevelopRequest, Error};

/// `etendue develop`
#[derive(Debug, Args)]
pub struct Develop {
    #[command(flatten)]
    pub request: DevelopRequest,
    #[command(flatten)]
    pub output: Output,
}

impl Develop {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || etendue::develop(&self.request, self.output.path(), self.output.existing()))
    }
}
