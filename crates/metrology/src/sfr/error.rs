//! Settings and errors of an edge measurement.

/// Reason why an edge cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SfrError {
    /// Too few pixels.
    #[error("a slanted edge needs at least 16 × 16 pixels, not {width} × {height}")]
    TooSmall {
        /// Pixels per row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A reading is NaN or infinite.
    #[error("the image contains readings that are not finite: give finite values")]
    NotFinite,
    #[error(
        "no slanted edge was found in this region of the image: expected one straight edge between two uniform surfaces ({0})"
    )]
    NoEdge(&'static str),
    /// Its angle cannot be measured.
    #[error(
        "the edge is at {angle_deg:.2}° to the rows or columns: expected 2° to 43°, so that its profile is sampled between the pixels"
    )]
    Angle {
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// The rows do not sample the profile densely enough.
    #[error(
        "the samples of the edge profile have gaps of {gap_px:.2} pixels: at {angle_deg:.2}° use more rows, or another angle"
    )]
    Gaps {
        /// Widest gap.
        gap_px: f64,
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// The edge rises within a gap between its samples.
    #[error(
        "the edge rises within the {gap_px:.2} pixels between the samples of its profile at {angle_deg:.2}°, so that the profile is aliased: use another \
         angle; check that the image is not point-sampled (nearest neighbour)"
    )]
    Steep {
        /// Widest gap.
        gap_px: f64,
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// A side is clipped.
    #[error("{percent:.1} % of the pixels are saturated: expose less, so that neither side of the edge is clipped")]
    Saturated {
        /// Percentage of clipped pixels.
        percent: f64,
    },
    /// The dark side is clipped at 0.
    #[error(
        "{percent:.1} % of the pixels read 0, where dark values are clipped: expose more, or raise the black level, so that neither side of the edge is clipped"
    )]
    Dark {
        /// Percentage of clipped pixels.
        percent: f64,
    },
    /// Invalid degree or reach.
    #[error("{0}")]
    Settings(&'static str),
}

/// Settings of an edge measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SfrSettings {
    /// Degree of the polynomial of the edge: 1 straight, 2 and 3 for edges bent by distortion.
    pub edge_degree: usize,
    /// Reach of the profile's fine detail on either side of the edge, pixels; `None`: 10, or as far as the image extends.
    pub reach_px: Option<f64>,
    /// Degree of the surfaces that model shading, one on either side of the edge beyond the reach: 0 for none, 1 or 2.
    pub shading_degree: usize,
    /// The reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// Last frequency of the curve, cycles per pixel.
    pub last_frequency: f64,
}

impl Default for SfrSettings {
    fn default() -> Self {
        Self { edge_degree: 1, reach_px: None, shading_degree: 0, full_scale: None, last_frequency: 1.0 }
    }
}
