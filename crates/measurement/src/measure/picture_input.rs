//! What all measurements of pictures ask for.

use super::readings::{Readings, Selection, SignalLevels};
use super::truth::{Truth, TruthInput};
use clap::Args;
use etendue_io::failure::Fault;
use etendue_io::failure::{Error, ErrorCode};
use std::fmt::Display;
use std::path::Path;

/// Which readings of a picture are measured, what they mean, and where the chart lies in them.
#[derive(Args, Clone, Debug, Default)]
pub struct PictureInput {
    /// Which part and channel.
    #[command(flatten)]
    pub selection: Selection,
    /// What the numbers mean, where the file does not say.
    #[command(flatten)]
    pub levels: SignalLevels,
    /// What the chart is and where.
    #[command(flatten)]
    pub truth: TruthInput,
}

impl PictureInput {
    /// The readings of a picture in proportion to light.
    pub(crate) fn linear(&self, picture: &Path) -> Result<Readings, Error> {
        self.selection.linear(picture)
    }

    /// Refuses a reading of no light where differences of readings alone count.
    pub(crate) fn check_without_black(&self) -> Result<(), Error> {
        match self.levels.black {
            None => Ok(()),
            Some(_) => Err(Error::argument(
                "black",
                "`black`: differences of readings alone count here, so that it changes nothing; leave it out",
            )
            .with_code(ErrorCode::NoEffect)),
        }
    }

    /// What the truth says of a picture, where one is given: of one of these charts, and of the picture's size.
    pub(crate) fn truth(&self, charts: &[&str], picture: &Path, readings: &Readings) -> Result<Option<Truth>, Error> {
        let truth = self.truth.read(charts)?;
        truth.iter().try_for_each(|truth| truth.fits(picture, readings))?;
        Ok(truth)
    }
}

/// What is wrong with a picture.
pub(crate) fn refused(picture: &Path, error: impl Display) -> Error {
    let fault = Fault::new(ErrorCode::NotMeasurable, format!("{}: {error}", picture.display()));
    Error::input(Fault { file: Some(picture.to_path_buf()), ..fault })
}
