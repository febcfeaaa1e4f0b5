//! `etendue weather`: fog, rain and snow laid over a stored radiance image.

use crate::args::folder::Output;
use crate::console::Console;
use crate::machine::print_written;
use clap::Args;
use etendue::{Error, WeatherRequest};
use std::path::PathBuf;

/// `etendue weather`
#[derive(Debug, Args)]
pub struct Weather {
    /// A spectral radiance image rendered with route = "pupil"
    #[arg(value_name = "RADIANCE.exr")]
    pub radiance: PathBuf,
    /// The weather file (TOML): fog, rain or snow, and the radiance of the air
    #[arg(long, value_name = "WEATHER.toml")]
    pub weather: PathBuf,
    #[command(flatten)]
    pub output: Output,
}

impl Weather {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let request = WeatherRequest { radiance: self.radiance.clone(), weather: self.weather.clone() };
        print_written(console, || etendue::weather(&request, self.output.folder()))
    }
}
