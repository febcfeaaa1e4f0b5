//! `etendue plan`: modelled effects, those left out with reasons, and estimated cost.

use crate::args::job::JobArgs;
use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::Error;

/// `etendue plan`
#[derive(Debug, Args)]
pub struct Plan {
    #[command(flatten)]
    pub job: JobArgs,
    /// Print one JSON document: cameras, settings, effects with their costs and the difference that omitting each would make, notes (docs/plan.md)
    #[arg(long)]
    pub json: bool,
    /// Print only the paths of the files that the job reads, including its own, one per line: the files needed to render it on another machine
    #[arg(long, conflicts_with = "json")]
    pub files: bool,
}

impl Plan {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let job = self.job.open(console, &machine::pool(None)?)?;
        if self.files {
            print_paths(console, job.files());
            return Ok(());
        }
        if !self.json {
            console.print(&console.spelled(&job.summary()));
            return Ok(());
        }
        let text = serde_json::to_string_pretty(&job.report()).map_err(|error| Error::Run(error.to_string()))?;
        console.print_json(&console.spelled(&format!("{text}\n")));
        Ok(())
    }
}
