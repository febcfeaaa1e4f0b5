//! What `measure ptc` is asked.

use crate::measure::readings::Selection;
use clap::Args;
use std::path::PathBuf;

/// `etendue measure ptc`
#[derive(Args, Clone, Debug)]
pub struct PtcRequest {
    /// A descriptor file of the EMVA 1288 reference program: levels of light with their pictures, two a level for the curve, more
    /// for DSNU and PRNU
    #[arg(value_name = "DESCRIPTOR.txt")]
    pub descriptor: PathBuf,
    /// The descriptor's photons are relative: leave out what needs their number
    #[arg(long)]
    pub relative_light: bool,
    /// Which part and channel of the pictures.
    #[command(flatten)]
    pub selection: Selection,
}

impl PtcRequest {
    /// The same as the program without options.
    pub fn new(descriptor: impl Into<PathBuf>) -> Self {
        Self { descriptor: descriptor.into(), relative_light: false, selection: Selection::default() }
    }
}

impl PtcRequest {
    /// A measurement for its figures alone.
    pub(crate) fn of(descriptor: PathBuf, selection: &Selection) -> Self {
        Self { descriptor, relative_light: true, selection: selection.clone() }
    }
}
