//! Dots: black discs in a square lattice on white, over all of the field and beyond its edge (ISO 17850, ISO 19084, the paper's
//! figure 10). Focal length, distortion, chromatic displacement.

use super::{GridSize, discs};
use crate::drawing::Drawing;
use crate::error::ChartError;
use crate::ray_camera::Footprint;

/// A chart of dots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dots {
    /// How many and how far apart. Default: 33 columns over the width that is seen, fewer where their steps would be less than
    /// 24 px of the picture's middle: a mosaic's colours see every other pixel.
    pub size: GridSize,
    /// Diameter over the distance between centres, 0.05 … 0.9.
    pub dot_ratio: f64,
}

impl Dots {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(0.05..=0.9).contains(&self.dot_ratio) {
            return Err(ChartError::option("dot-ratio", self.dot_ratio, "expected 0.05 … 0.9"));
        }
        let grid = self.size.in_room(seen.outer_mm, usual_columns(seen.outer_mm.x / seen.pixel_mm), 3)?;
        let mut drawing = discs::draw(seen, &grid, self.dot_ratio, |_, _| true);
        drawing.note("columns", grid.columns);
        drawing.note("rows", grid.rows);
        Ok(drawing)
    }
}

/// Columns over a picture's width, px: steps of 24 px that leave six at least, whose steps are 12 px at least.
fn usual_columns(width_px: f64) -> u32 {
    const MOST: f64 = 33.0;
    const FEW: f64 = 6.0;
    const STEP_PX: f64 = 24.0;
    const MIN_STEP_PX: f64 = 12.0;
    // Rounding shall not take the last column away.
    let fit = |step: f64| (width_px / step * (1.0 + 1e-9)).floor();
    fit(STEP_PX).max(fit(MIN_STEP_PX).min(FEW)).clamp(3.0, MOST) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_suit_the_measurement() {
        let columns = [4000.0, 800.0, 640.0, 160.0, 120.0, 80.0, 20.0].map(usual_columns);
        assert_eq!(columns, [33, 33, 26, 6, 6, 6, 3]);
    }
}
