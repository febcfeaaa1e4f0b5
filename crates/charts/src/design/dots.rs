//! Dots: black discs in a square lattice on white, over all of the field and beyond its edge (ISO 17850, ISO 19084, the paper's
//! figure 10). Focal length, distortion, chromatic displacement.
//!
//! Three dots are left out beside the middle, as marks of orientation: one, one three columns to its right, and one two rows below it. A picture in which the longer leg
//! does not lie to the right of the shorter one as the chart has it is mirrored, however it is turned and wherever its centre lies. Charts of fewer than [`MIN_MARKED`]
//! dots, or of rows and columns too few, have none: each dot counts there.

use super::{GridSize, discs};
use crate::drawing::Drawing;
use crate::error::ChartError;
use crate::ray_camera::Footprint;

/// The least number of dots of a chart with marks.
const MIN_MARKED: usize = 150;
/// Columns and rows from the first mark to the chart's middle, and from it to the other two.
const FIRST: [usize; 2] = [4, 3];
const LEGS: [usize; 2] = [3, 2];

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
            return Err(ChartError::option("dot_ratio", self.dot_ratio, "expected 0.05 … 0.9"));
        }
        let grid = self.size.in_room(seen.outer_mm, usual_columns(seen.outer_mm.x / seen.pixel_mm), 3)?;
        let marks = marks(grid.columns, grid.rows);
        // Cells are numbered from 1.
        let here = |column: usize, row: usize| !marks.contains(&[column.wrapping_sub(1), row.wrapping_sub(1)]);
        let mut drawing = discs::draw(seen, &grid, self.dot_ratio, here);
        drawing.note("columns", grid.columns);
        drawing.note("rows", grid.rows);
        drawing.note("left_out", marks.iter().map(|mark| mark.to_vec()).collect::<Vec<_>>());
        Ok(drawing)
    }
}

/// Column and row, from 0, of the dots that are left out.
fn marks(columns: usize, rows: usize) -> Vec<[usize; 2]> {
    let middle = [columns / 2, rows / 2];
    // Each mark has dots on its four sides.
    let room = middle[0] > FIRST[0] && middle[1] > FIRST[1];
    if columns * rows < MIN_MARKED || !room {
        return Vec::new();
    }
    let [x, y] = [middle[0] - FIRST[0], middle[1] - FIRST[1]];
    vec![[x, y], [x + LEGS[0], y], [x, y + LEGS[1]]]
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
    fn large_charts_have_marks() {
        assert_eq!(marks(33, 25), [[12, 9], [15, 9], [12, 11]]);
        assert!(marks(12, 9).is_empty() && marks(60, 6).is_empty());
    }

    #[test]
    fn steps_suit_the_measurement() {
        let columns = [4000.0, 800.0, 640.0, 160.0, 120.0, 80.0, 20.0].map(usual_columns);
        assert_eq!(columns, [33, 33, 26, 6, 6, 6, 3]);
    }
}
