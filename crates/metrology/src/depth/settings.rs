//! What depth is measured with, and its ranges.

use super::error::DepthError;

/// How depth is judged.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthSettings {
    /// Limits of the ranges, m, rising.
    pub ranges_m: Vec<f64>,
    /// An outlier is off by more than this share of the depth …
    pub outlier_ratio: f64,
    /// … and by more than this, m.
    pub outlier_least_m: f64,
    /// A jump of more than this share of the depth is an edge.
    pub edge_ratio: f64,
    /// Pixels this near to a jump are edge pixels.
    pub edge_px: usize,
    /// A stereo rig's focal length times its base, px m, for errors of disparity.
    pub focal_base_px_m: Option<f64>,
    /// What is done to the estimate before.
    pub alignment: Alignment,
}

/// What is done to an estimate before it is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Alignment {
    /// Nothing: it is in metres.
    #[default]
    None,
    /// It is multiplied by the median of truth over estimate.
    Median,
}

impl Default for DepthSettings {
    fn default() -> Self {
        Self {
            ranges_m: vec![0.0, 5.0, 10.0, 20.0, 40.0, 80.0, f64::INFINITY],
            outlier_ratio: 0.05,
            outlier_least_m: 0.0,
            edge_ratio: 0.1,
            edge_px: 2,
            focal_base_px_m: None,
            alignment: Alignment::None,
        }
    }
}

impl DepthSettings {
    pub(super) fn check(&self) -> Result<(), DepthError> {
        let limits = &self.ranges_m;
        let rising = limits.len() >= 2 && limits[0] >= 0.0 && limits.windows(2).all(|pair| pair[0] < pair[1]);
        if !rising {
            return Err(DepthError::Ranges);
        }
        let shares = [
            ("outlier share", self.outlier_ratio),
            ("least error of an outlier", self.outlier_least_m),
            ("edge ratio", self.edge_ratio),
        ];
        let wrong = shares.into_iter().find(|(_, value)| !(value.is_finite() && *value >= 0.0));
        let wrong = wrong.map(|(name, value)| DepthError::Setting { name, value, least: "0" });
        let rig = self.focal_base_px_m.filter(|value| !(value.is_finite() && *value > 0.0));
        let rig = rig.map(|value| DepthError::Setting { name: "focal length times base", value, least: "more than 0" });
        wrong.or(rig).map_or(Ok(()), Err)
    }
}
