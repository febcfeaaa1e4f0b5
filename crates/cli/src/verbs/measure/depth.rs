//! `etendue measure depth`.

use super::report::ReportArgs;
use crate::args::choice::{Word, choice};
use crate::console::Console;
use clap::Args;
use etendue::Error;
use etendue::measure::{self, DepthAlignment, DepthRequest};
use std::path::PathBuf;

const ALIGNMENTS: [Word<DepthAlignment>; 2] = [
    (DepthAlignment::None, "none", "Nothing"),
    (DepthAlignment::Median, "median", "Multiply by the median of truth over estimate"),
];

/// `etendue measure depth`
#[derive(Debug, Args)]
pub struct DepthArgs {
    /// The estimate: one channel of depth (EXR, PFM, TIFF of floats, PNG of 16 bits …; 0, NaN and infinity are missing)
    #[arg(value_name = "ESTIMATE")]
    pub estimate: PathBuf,
    /// The truth: a ground-truth EXR, or one channel of depth
    #[arg(value_name = "TRUTH")]
    pub truth: PathBuf,
    /// The estimate's channel [default: depth.Z, or the only one]
    #[arg(long, value_name = "NAME")]
    pub estimate_channel: Option<String>,
    /// The truth's channel [default: depth.Z, or the only one]
    #[arg(long, value_name = "NAME")]
    pub truth_channel: Option<String>,
    /// Metres a number of the estimate, e.g. 0.001 for millimetres
    #[arg(long, value_name = "M", default_value_t = 1.0, allow_negative_numbers = true)]
    pub estimate_unit_m: f64,
    /// Metres a number of the truth
    #[arg(long, value_name = "M", default_value_t = 1.0, allow_negative_numbers = true)]
    pub truth_unit_m: f64,
    /// Limits of the ranges, m, e.g. 0,10,30,100
    #[arg(long, value_name = "M,…", value_delimiter = ',')]
    pub ranges_m: Vec<f64>,
    /// An outlier is off by more than this share of the depth
    #[arg(long, value_name = "SHARE", default_value_t = 0.05, allow_negative_numbers = true)]
    pub outlier_ratio: f64,
    /// … and by more than this, m
    #[arg(long, value_name = "M", default_value_t = 0.0, allow_negative_numbers = true)]
    pub outlier_least_m: f64,
    /// A stereo rig's focal length in pixels times its base in metres: tells errors of disparity (D1, EPE) as well
    #[arg(long, value_name = "PX·M", allow_negative_numbers = true)]
    pub focal_base_px_m: Option<f64>,
    /// What is done to the estimate first: networks may know depth but for a factor
    #[arg(long, value_parser = choice(ALIGNMENTS), default_value = "none")]
    pub align: DepthAlignment,
    /// A jump of the truth by more than this share of the depth is an edge
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, allow_negative_numbers = true)]
    pub edge_ratio: f64,
    /// Pixels this near to an edge are told apart
    #[arg(long, value_name = "PX", default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=100))]
    pub edge_px: u32,
    #[command(flatten)]
    pub report: ReportArgs,
}

impl DepthArgs {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        self.report.show(console, &measure::depth_errors(&self.into())?)
    }
}

impl From<&DepthArgs> for DepthRequest {
    fn from(a: &DepthArgs) -> Self {
        Self {
            estimate: a.estimate.clone(),
            truth: a.truth.clone(),
            estimate_channel: a.estimate_channel.clone(),
            truth_channel: a.truth_channel.clone(),
            estimate_unit_m: a.estimate_unit_m,
            truth_unit_m: a.truth_unit_m,
            ranges_m: a.ranges_m.clone(),
            outlier_ratio: a.outlier_ratio,
            outlier_least_m: a.outlier_least_m,
            focal_base_px_m: a.focal_base_px_m,
            align: a.align,
            edge_ratio: a.edge_ratio,
            edge_px: a.edge_px,
        }
    }
}
