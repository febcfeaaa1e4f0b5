//! `etendue import`: a scene of another program as files of the format.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, ImportRequest};

/// `etendue import`
#[derive(Debug, Args)]
pub struct Import {
    #[command(flatten)]
    pub request: ImportRequest,
    #[command(flatten)]
    pub output: Output,
}

impl Import {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || {
            etendue::import(&self.request, self.output.path(), self.output.existing(), console.observer())
        })
    }
}
