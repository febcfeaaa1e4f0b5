//! `etendue plan`: what will be modelled, what is left out and why, and what it will cost.

use crate::args::job::JobArgs;
use crate::machine;
use crate::output::print;
use clap::Args;
use etendue::Error;

/// `etendue plan`
#[derive(Debug, Args)]
pub struct Plan {
    #[command(flatten)]
    pub job: JobArgs,
}

impl Plan {
    pub fn run(&self) -> Result<(), Error> {
        let job = self.job.open(&machine::pool(None)?)?;
        print(&job.summary());
        Ok(())
    }
}
