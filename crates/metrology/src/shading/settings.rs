//! How shading is measured.

/// How a flat field is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingSettings {
    /// Reading of no light.
    pub black: f64,
    /// Reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// Centre of the fall-off, raster coordinates; `None`: the picture's.
    pub centre_px: Option<(f64, f64)>,
    /// Rings of the profile.
    pub rings: usize,
    /// Blocks of the map along each side, an odd number.
    pub blocks: usize,
}

impl Default for ShadingSettings {
    fn default() -> Self {
        Self { black: 0.0, full_scale: None, centre_px: None, rings: 20, blocks: 11 }
    }
}
