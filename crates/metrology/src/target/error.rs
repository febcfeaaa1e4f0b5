//! Errors of chart detection.

/// Reason why an image gives no grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TargetError {
    /// No points, or too few.
    #[error(
        "no {pattern} was found ({best} points in rows and columns, {least} are needed): capture the whole chart in focus, uniformly lit and not \
         saturated, with a pitch of at least 10 px"
    )]
    None {
        /// Description of the chart.
        pattern: &'static str,
        /// Number of points of the best attempt.
        best: usize,
        /// Minimum number of points.
        least: usize,
    },
    /// Points in rows and columns, with too many gaps.
    #[error("{points} points were found on a grid of {} × {}: too many are missing; check that nothing covers the chart", size[0], size[1])]
    Gaps {
        /// Number of points.
        points: usize,
        /// Columns and rows.
        size: [usize; 2],
    },
    /// Too small a chart for measurement.
    #[error(
        "the points in rows and columns are {step_px:.1} px apart, {least_px} px are needed: the pattern is not a chart, or the chart is too far away"
    )]
    Small {
        /// Median distance of neighbours, px.
        step_px: f64,
        /// Minimum, px.
        least_px: f64,
    },
    /// More than one chart.
    #[error(
        "{} and {} points were found on two separate grids: two charts, or one that is partly covered; choose a region of the image that contains one \
         whole chart (`region`)", points[0], points[1]
    )]
    Several {
        /// Numbers of points of the two largest.
        points: [usize; 2],
    },
    /// A larger chart than stated.
    #[error("a grid of {} × {} points was found where {} × {} were stated; a checkerboard counts its inner corners", actual[0], actual[1], stated[0], stated[1])]
    Larger {
        /// Detected.
        actual: [usize; 2],
        stated: [usize; 2],
    },
}

/// Minimum number of points of a grid whose size is not stated.
pub(super) const MIN_GRID_POINTS: usize = 16;
