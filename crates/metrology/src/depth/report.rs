//! What is found of an estimated depth.

use crate::Estimate;

/// Errors of a set of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthErrors {
    /// Pixels with truth and estimate.
    pub pixels: usize,
    /// Pixels with truth and no estimate.
    pub missing: usize,
    /// Mean error, m.
    pub bias_m: Estimate,
    /// Mean magnitude of the error, m.
    pub mean_m: Estimate,
    /// Root mean square error, m.
    pub rmse_m: Estimate,
    /// Mean magnitude of the relative error.
    pub relative: Estimate,
    /// Mean of e²/d, m.
    pub squared_relative_m: Estimate,
    /// Root mean square difference of natural logarithms.
    pub rmse_log: Estimate,
    /// Their standard deviation: SILog.
    pub scale_invariant: Estimate,
    /// Root mean square error of 1/d, 1/km.
    pub inverse_rmse_per_km: Estimate,
    /// Share of outliers.
    pub outliers: Estimate,
    /// Shares of ratios within 1.25, 1.25², 1.25³.
    pub within: [Estimate; 3],
    /// Share of disparities off by more than 3 px and 5 %, and mean error of disparity, px; of a stereo rig.
    pub disparity: Option<[Estimate; 2]>,
}

/// Errors over all, by range, and at edges.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthReport {
    /// All pixels but those at edges.
    pub all: DepthErrors,
    /// The same by range: lower and upper limit, m.
    pub ranges: Vec<(f64, f64, DepthErrors)>,
    /// Pixels at edges.
    pub edges: DepthErrors,
    /// What the estimate was multiplied by.
    pub scale: f64,
}
