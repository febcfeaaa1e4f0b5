//! Circles to calibrate with, all of them in view: a square lattice, or a staggered one (every other row shifted by half of
//! the distance) that shows which side is up.

use super::{GridSize, discs};
use crate::drawing::Drawing;
use crate::error::ChartError;
use crate::ray_camera::Footprint;

/// How much of what is wholly seen the lattice takes.
const ROOM: f64 = 0.92;
/// Diameter over the side of a circle's cell.
const DOT_SHARE: f64 = 0.6;

/// A lattice of circles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circles {
    /// How many, and how far apart (in a staggered lattice: the cells, of which every other one holds a circle).
    pub size: GridSize,
    /// Whether the lattice is staggered.
    pub asymmetric: bool,
}

impl Circles {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let columns = if self.asymmetric { 15 } else { 11 };
        let grid = self.size.in_room(seen.inner_mm * ROOM, columns, 3)?;
        let here = |column: usize, row: usize| !self.asymmetric || (column + row).is_multiple_of(2);
        let mut drawing = discs::draw(seen, &grid, DOT_SHARE, here);
        drawing.note("cells", vec![grid.columns, grid.rows]);
        drawing.note("asymmetric", self.asymmetric);
        Ok(drawing)
    }
}
