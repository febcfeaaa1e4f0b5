//! Why no chart was found.

/// Why a picture gives no grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TargetError {
    /// Nothing, or too little.
    #[error(
        "no {sought} was found ({best} points in rows and columns, {least} are needed): photograph the whole chart in focus, evenly \
         lit and not saturated, its steps at least 10 px wide"
    )]
    None {
        /// What was looked for.
        sought: &'static str,
        /// Points of the best try.
        best: usize,
        /// Points that would do.
        least: usize,
    },
    /// Points in rows and columns, with too many gaps.
    #[error("{points} points were found on a grid of {} × {}: too many are missing; see that nothing covers the chart", size[0], size[1])]
    Gaps {
        /// Points found.
        points: usize,
        /// Columns and rows.
        size: [usize; 2],
    },
    /// Too small to be a chart that can be measured.
    #[error(
        "the points in rows and columns lie {step_px:.1} px apart, {least_px} px are needed: a pattern that is no chart, or a chart too far away"
    )]
    Small {
        /// The median distance of neighbours, px.
        step_px: f64,
        /// What would do, px.
        least_px: f64,
    },
    /// More than one chart.
    #[error(
        "{} and {} points were found in rows and columns that do not join: two charts, or one that something covers; \
         choose a part of the picture that holds one whole chart (`region`)", points[0], points[1]
    )]
    Several {
        /// Points of the two largest.
        points: [usize; 2],
    },
    /// Another chart than stated.
    #[error("a grid of {} × {} points was found where {} × {} were stated; a checkerboard counts its inner corners", found[0], found[1], stated[0], stated[1])]
    Larger {
        /// Found.
        found: [usize; 2],
        /// Stated.
        stated: [usize; 2],
    },
}

/// Least points of a grid whose size is not stated.
pub(super) const LEAST: usize = 16;
