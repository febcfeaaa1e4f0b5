//! How an edge is measured, and why it cannot be.

/// Why an edge cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SfrError {
    /// Too few pixels.
    #[error("a slanted edge needs at least 16 × 16 pixels, not {width} × {height}")]
    TooSmall {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A reading is NaN or infinite.
    #[error("the picture holds readings that are no numbers: give finite values")]
    NotFinite,
    /// There is no edge.
    #[error(
        "no slanted edge is in this part of the picture: expected one straight edge between two even surfaces ({0})"
    )]
    NoEdge(&'static str),
    /// Its angle cannot be measured.
    #[error(
        "the edge is at {angle_deg:.2}° to the pixels' rows or columns: expected 2° to 43°, so that its profile is sampled between the pixels"
    )]
    Angle {
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// The rows do not sample the profile densely enough.
    #[error(
        "the edge's profile is sampled with gaps of {gap_px:.2} pixels only: at {angle_deg:.2}° take more rows, or another angle"
    )]
    Gaps {
        /// The widest gap.
        gap_px: f64,
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// The edge rises within a gap of its samples.
    #[error(
        "the edge rises within the {gap_px:.2} pixels between the samples of its profile at {angle_deg:.2}°, so that finer structure is \
         folded back: take another angle; is the picture sampled at points (nearest neighbour)?"
    )]
    Steep {
        /// The widest gap.
        gap_px: f64,
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// A side is clipped.
    #[error("{percent:.1} % of the pixels are saturated: expose less, so that both sides of the edge keep their noise")]
    Saturated {
        /// Share of pixels.
        percent: f64,
    },
    /// The dark side is cut.
    #[error(
        "{percent:.1} % of the pixels read 0, where darkness is cut: expose more, or raise the black level, so that both sides keep their noise"
    )]
    Dark {
        /// Share of pixels.
        percent: f64,
    },
    /// The edge's degree or reach makes no sense.
    #[error("{0}")]
    Settings(&'static str),
}

/// How an edge is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SfrSettings {
    /// Degree of the polynomial that the edge follows: 1 straight, 2 and 3 for edges bent by distortion.
    pub edge_degree: usize,
    /// How far from the edge the profile has fine detail, pixels; `None`: 10, or as far as the picture reaches.
    pub reach_px: Option<f64>,
    /// Degree of the surfaces, one on either side of the edge beyond the reach, by which shading is taken off: 0 for none, 1 or 2.
    pub shading_degree: usize,
    /// The reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// The last frequency of the curve, cycles a pixel.
    pub last_frequency: f64,
}

impl Default for SfrSettings {
    fn default() -> Self {
        Self { edge_degree: 1, reach_px: None, shading_degree: 0, full_scale: None, last_frequency: 1.0 }
    }
}
