//! `etendue dataset`: a job varied sample by sample, in formats for training and tests.

use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::{Error, ExistingFiles};
use etendue_arguments::integer;
use etendue_dataset::{DatasetRequest, dataset};

/// `etendue dataset`
#[derive(Debug, Args)]
pub struct Dataset {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    #[command(flatten)]
    pub request: DatasetRequest,
    /// Resume the data set in the folder: complete samples are kept, and more may be added
    #[arg(long, conflicts_with = "overwrite")]
    pub resume: bool,
    /// Worker threads [default: one per processor]. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = integer(1..=1024))]
    pub threads: Option<u32>,
}

impl Dataset {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let simd = machine::simd()?;
        let pool = machine::pool(self.threads)?;
        let request =
            DatasetRequest { job: self.job.request().into_output(&self.output.output), simd, ..self.request.clone() };
        let (folder, existing) = (self.output.path(), self.output.existing());
        let existing = if self.resume { ExistingFiles::Resume } else { existing };
        let written = pool.install(|| dataset(&request, folder, existing, console.observer()))?;
        print_paths(console, &written);
        Ok(())
    }
}
