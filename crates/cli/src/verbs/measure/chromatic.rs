//! `etendue measure chromatic`.

use super::chart_points::ChartPointsArgs;
use super::report::ReportArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, ChromaticRequest};
use std::path::PathBuf;

/// `etendue measure chromatic`
#[derive(Debug, Args)]
pub struct ChromaticArgs {
    /// A picture in colour of a plane chart that fills the field
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub chart: ChartPointsArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl ChromaticArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.report.show(console, &measure::chromatic(&self.into())?)
    }
}

impl From<&ChromaticArgs> for ChromaticRequest {
    fn from(a: &ChromaticArgs) -> Self {
        Self { file: a.file.clone(), chart: (&a.chart).into() }
    }
}
