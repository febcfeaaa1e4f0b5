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
        let found = measure::compare(&self.request)?;
        self.report.show(console, &found.report)?;
        let [one, other] = &found.names;
        match found.differing.is_empty() {
            true => Ok(()),
            false => Err(Error::Run(format!("{one} and {other} differ: {}", found.differing.join(", ")))),
        }
    }
}
