//! `etendue measure dark-current`.

use super::report::ReportArgs;
use super::selection::SelectionArgs;
use crate::args::words::series;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, DarkCurrentRequest};
use std::path::PathBuf;

/// `etendue measure dark-current`
#[derive(Debug, Args)]
pub struct DarkCurrentArgs {
    /// Descriptors of photon transfer at several temperatures of the sensor in °C, three or more
    #[arg(value_name = "CELSIUS:DESCRIPTOR.txt", required = true, value_parser = series)]
    pub series: Vec<(f64, PathBuf)>,
    /// The temperature that the dark current is told at, °C
    #[arg(long, value_name = "CELSIUS", default_value_t = 25.0, allow_negative_numbers = true)]
    pub reference_c: f64,
    #[command(flatten)]
    pub selection: SelectionArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl DarkCurrentArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.report.show(console, &measure::dark_current(&self.into(), console.observer())?)
    }
}

impl From<&DarkCurrentArgs> for DarkCurrentRequest {
    fn from(a: &DarkCurrentArgs) -> Self {
        Self { series: a.series.clone(), reference_c: a.reference_c, selection: (&a.selection).into() }
    }
}
