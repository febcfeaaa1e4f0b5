//! `etendue rig`: poses and projections of a job's cameras, for other programs.

use crate::args::folder::Output;
use crate::args::job::JobArgs;
use crate::console::{Console, print_paths};
use crate::machine;
use clap::Args;
use etendue::Error;
use etendue_arguments::frames;

/// `etendue rig`
#[derive(Debug, Args)]
pub struct Rig {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub output: Output,
    /// Frames whose poses are written, first to last (the last excluded)
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: std::ops::Range<u32>,
}

impl Rig {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let pool = machine::pool(None)?;
        let job = self.job.open(console, &pool)?;
        let written =
            job.save_calibration_files(&self.frames, self.output.path(), self.output.existing(), console.observer())?;
        print_paths(console, &written);
        Ok(())
    }
}
