//! What all measurements of pictures ask for.

use super::readings::{Levels, Readings, Selection};
use super::report::{Report, Telling};
use super::truth::{Truth, TruthArguments};
use crate::failure::Failure;
use clap::Args;
use std::fmt::Display;
use std::path::Path;

/// Which readings, what they mean, where the chart lies in them, and how results are told.
#[derive(Debug, Args)]
pub struct Inquiry {
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub levels: Levels,
    #[command(flatten)]
    pub truth: TruthArguments,
    #[command(flatten)]
    pub telling: Telling,
}

impl Inquiry {
    /// The readings of a picture in proportion to light.
    pub(super) fn linear(&self, picture: &Path) -> Result<Readings, Failure> {
        self.selection.linear(picture)
    }

    /// What the truth says of a picture, where one is given: of one of these charts, and of the picture's size.
    pub(super) fn truth(&self, charts: &[&str], picture: &Path, readings: &Readings) -> Result<Option<Truth>, Failure> {
        let truth = self.truth.read(charts)?;
        truth.iter().try_for_each(|truth| truth.fits(picture, readings))?;
        Ok(truth)
    }

    pub(super) fn tell(&self, report: &Report) -> Result<(), Failure> {
        report.tell(&self.telling)
    }
}

/// What is wrong with a picture.
pub(super) fn refused(picture: &Path, error: impl Display) -> Failure {
    Failure::input(format!("{}: {error}", picture.display()))
}
