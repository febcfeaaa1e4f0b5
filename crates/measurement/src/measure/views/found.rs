//! What views of a chart tell.

use crate::measure::chart_points::Seen;
use etendue_metrology::calibrate::Calibrated;

/// The views and the camera that saw them.
pub(crate) struct Found {
    /// The model's name.
    pub model: String,
    /// Those that are in it.
    pub views: Vec<Seen>,
    pub camera: Calibrated,
    /// What a user should know of the fit.
    pub notes: Vec<String>,
}
