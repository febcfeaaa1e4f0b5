//! `etendue measure focal`.

use super::report::{CameraOut, ReportArgs};
use super::views::ViewsArgs;
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, FocalRequest};

/// `etendue measure focal`
#[derive(Debug, Args)]
#[command(
    after_help = "One picture needs --distance-mm; its principal point is taken for the picture's middle unless --principal-px \
    says otherwise. What is told is the principal distance (camera constant): the focal length for a lens focused at infinity; at \
    a distance D it is longer, f D/(D − f)."
)]
pub struct FocalArgs {
    #[command(flatten)]
    pub views: ViewsArgs,
    #[command(flatten)]
    pub report: ReportArgs,
    #[command(flatten)]
    pub out: CameraOut,
}

impl FocalArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let report = measure::focal(&self.into(), console.observer())?;
        self.out.write(&report)?;
        self.report.show(console, &report)
    }
}

impl From<&FocalArgs> for FocalRequest {
    fn from(a: &FocalArgs) -> Self {
        Self { views: (&a.views).into(), camera_keys: a.out.camera_out.is_some() }
    }
}
