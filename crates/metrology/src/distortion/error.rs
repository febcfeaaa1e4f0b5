//! Why a picture has no distortion to tell.

use crate::fit::FitError;

/// Why a picture has no distortion to tell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// Too few points.
    #[error(
        "{points} points of the chart are too few for a distortion curve; at least {least} are needed: use a chart of more points"
    )]
    Few {
        /// Points found.
        points: usize,
        /// Points that would do.
        least: usize,
    },
    /// The chart does not show the centre.
    #[error("the chart does not cover the picture's centre, ({:.1}, {:.1}) px, where ideal scale is taken: centre the chart, or state another centre", centre_px[0], centre_px[1])]
    Centre {
        /// The centre, px.
        centre_px: [f64; 2],
    },
    /// A fit failed.
    #[error(transparent)]
    Fit(#[from] FitError),
}
