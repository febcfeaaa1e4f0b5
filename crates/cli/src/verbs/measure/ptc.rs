//! `etendue measure ptc`.

use super::report::{CameraOut, ReportArgs};
use super::selection::SelectionArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, PtcRequest};
use std::path::PathBuf;

/// `etendue measure ptc`
#[derive(Debug, Args)]
pub struct PtcArgs {
    /// A descriptor file of the EMVA 1288 reference program: levels of light with their pictures, two a level for the curve, more
    /// for DSNU and PRNU
    #[arg(value_name = "DESCRIPTOR.txt")]
    pub descriptor: PathBuf,
    /// The descriptor's photons are relative: leave out what needs their number
    #[arg(long)]
    pub relative_light: bool,
    #[command(flatten)]
    pub selection: SelectionArgs,
    #[command(flatten)]
    pub report: ReportArgs,
    #[command(flatten)]
    pub out: CameraOut,
}

impl PtcArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let report = measure::ptc(&self.into(), console.observer())?;
        self.out.write(&report)?;
        self.report.show(console, &report)
    }
}

impl From<&PtcArgs> for PtcRequest {
    fn from(a: &PtcArgs) -> Self {
        Self { descriptor: a.descriptor.clone(), relative_light: a.relative_light, selection: (&a.selection).into() }
    }
}
