//! `etendue expose`: a stored radiance image captured by another lens and sensor.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, ExposeRequest};

/// `etendue expose`
#[derive(Debug, Args)]
pub struct Expose {
    #[command(flatten)]
    pub request: ExposeRequest,
    #[command(flatten)]
    pub output: Output,
}

impl Expose {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || {
            etendue::expose(&self.request, self.output.path(), self.output.existing(), console.observer())
        })
    }
}
