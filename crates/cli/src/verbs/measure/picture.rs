//! What all measurements of pictures ask for.

use super::report::ReportArgs;
use super::selection::{LevelsArgs, SelectionArgs};
use super::truth::TruthArgs;
use clap::Args;
use etendue::measure::PictureInput;

/// Which readings, what they mean, where the chart lies in them, and how results are told.
#[derive(Debug, Args)]
pub struct PictureArgs {
    #[command(flatten)]
    pub selection: SelectionArgs,
    #[command(flatten)]
    pub levels: LevelsArgs,
    #[command(flatten)]
    pub truth: TruthArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl From<&PictureArgs> for PictureInput {
    fn from(a: &PictureArgs) -> Self {
        Self { selection: (&a.selection).into(), levels: (&a.levels).into(), truth: (&a.truth).into() }
    }
}
