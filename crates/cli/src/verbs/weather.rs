//! `etendue weather`: adds fog, rain and snow to a stored radiance image.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, WeatherRequest};

/// `etendue weather`
#[derive(Debug, Args)]
pub struct Weather {
    #[command(flatten)]
    pub request: WeatherRequest,
    #[command(flatten)]
    pub output: Output,
}

impl Weather {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        print_written(console, || etendue::weather(&self.request, self.output.path(), self.output.existing()))
    }
}
