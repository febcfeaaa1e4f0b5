//! `etendue flat`: uniform illumination of a camera's bare sensor.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, FlatRequest};

/// `etendue flat`
#[derive(Debug, Args)]
pub struct Flat {
    #[command(flatten)]
    pub request: FlatRequest,
    #[command(flatten)]
    pub output: Output,
}

impl Flat {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || {
            etendue::flat(&self.request, self.output.path(), self.output.existing(), console.observer())
        })
    }
}
