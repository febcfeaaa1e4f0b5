//! `etendue measure compare`.

use super::report::ReportArgs;
use crate::args::words::positive;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, CompareRequest};
use std::path::PathBuf;

/// `etendue measure compare`
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// A measurement (what --json printed), or the camera file (TOML) that was measured
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// The same of the other; relative errors are against this one
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Where a camera file is compared with photon transfer: the light's wavelength, for the quantum efficiency
    #[arg(long, value_name = "NM", value_parser = positive)]
    pub wavelength_nm: Option<f64>,
    /// Where a camera file is compared with the response of edges or a tone curve: the light's spectrum [default: D65]
    #[arg(long, value_name = "NAME")]
    pub illuminant: Option<String>,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl CompareArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let found = measure::compare(&self.into())?;
        self.report.show(console, &found.report)?;
        let [one, other] = &found.names;
        match found.differing.is_empty() {
            true => Ok(()),
            false => Err(Error::Run(format!("{one} and {other} differ: {}", found.differing.join(", ")))),
        }
    }
}

impl From<&CompareArgs> for CompareRequest {
    fn from(a: &CompareArgs) -> Self {
        Self {
            a: a.a.clone(),
            b: a.b.clone(),
            wavelength_nm: a.wavelength_nm,
            illuminant: a.illuminant.clone(),
            set: a.set.clone(),
        }
    }
}
