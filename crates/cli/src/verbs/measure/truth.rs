//! Where a chart's truth lies.

use clap::Args;
use etendue::measure::TruthInput;
use std::path::PathBuf;

/// Where the chart's truth lies.
#[derive(Clone, Debug, Args)]
pub struct TruthArgs {
    /// The truth.json of `etendue chart`, which says what is in the picture and where
    #[arg(long, value_name = "truth.json", conflicts_with = "region")]
    pub truth: Option<PathBuf>,
    /// With --truth: the camera that took the picture [default: the first]
    #[arg(long, value_name = "NAME", requires = "truth")]
    pub camera: Option<String>,
}

impl From<&TruthArgs> for TruthInput {
    fn from(a: &TruthArgs) -> Self {
        Self { truth: a.truth.clone(), camera: a.camera.clone() }
    }
}
