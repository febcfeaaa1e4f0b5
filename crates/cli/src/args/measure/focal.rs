//! `etendue measure focal`.

use super::report::{CameraOut, ReportArgs};
use super::views::ViewsArgs;
use clap::Args;
use etendue::measure::FocalRequest;

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

impl From<&FocalArgs> for FocalRequest {
    fn from(a: &FocalArgs) -> Self {
        Self { views: (&a.views).into(), camera_keys: a.out.camera_out.is_some() }
    }
}
