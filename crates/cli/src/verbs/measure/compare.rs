//! `etendue measure compare`.

use super::report::ReportArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, CompareRequest};

/// `etendue measure compare`
#[derive(Debug, Args)]
pub struct CompareArgs {
    #[command(flatten)]
    pub request: CompareRequest,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl CompareArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let comparison = measure::compare(&self.request)?;
        self.report.show(console, &comparison.report)?;
        let [one, other] = &comparison.names;
        match comparison.differing.is_empty() {
            true => Ok(()),
            false => Err(Error::Run(format!("{one} and {other} differ: {}", comparison.differing.join(", ")))),
        }
    }
}
