//! Dots: black discs in a square lattice on white, over all of the field and beyond its edge (ISO 17850, ISO 19084, the paper's
//! figure 10). Focal length, distortion, chromatic displacement.

use super::{GridSize, discs};
use crate::drawing::Drawing;
use crate::error::ChartError;
use crate::eye::Footprint;

/// A chart of dots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dots {
    /// How many and how far apart. Default: 33 columns over the width that is seen.
    pub size: GridSize,
    /// Diameter over the distance between centres, 0.05 … 0.9.
    pub dot_share: f64,
}

impl Dots {
    pub(super) fn draw(&self, seen: &Footprint) -> Result<Drawing, ChartError> {
        if !(0.05..=0.9).contains(&self.dot_share) {
            return Err(ChartError::option("dot-share", self.dot_share, "expected 0.05 … 0.9"));
        }
        let grid = self.size.in_room(seen.outer_mm, 33, 3)?;
        let mut drawing = discs::draw(seen, &grid, self.dot_share, |_, _| true);
        drawing.note("columns", grid.columns);
        drawing.note("rows", grid.rows);
        Ok(drawing)
    }
}
