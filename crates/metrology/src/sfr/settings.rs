//! How an edge is measured.

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
