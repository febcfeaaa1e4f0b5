//! The density from which sample displacements are drawn: the core of a point spread.
//!
//! Mass is gathered on a lattice of [`CELLS_PER_PX`] cells per pixel with bilinear weights, uniform within a cell. This widens the spread by (1/6 +
//! 1/12)/256 px² per direction: its modulation at half a cycle per pixel falls by less than half a per cent.

use core::f64::consts::FRAC_PI_2;

use etendue_core::maths::f64::sin_cos;
use glam::DVec2;

/// End of the core, along rows and columns, px.
pub(super) const CORE_PX: f64 = 2.5;
/// Distance up to which all of the light belongs to the core, px.
const WHOLE_PX: f64 = 1.0;
/// Cells per pixel.
const CELLS_PER_PX: f64 = 16.0;
/// Cells along a side: one more at each end, for the bilinear weights.
const SIDE: usize = 2 * 40 + 2;

/// The fraction of the light at an offset (px) in the core: 1 at the centre, 0 beyond it, smooth in between, so that the remainder is smooth.
pub(super) fn core_share(offset_px: DVec2) -> f64 {
    let along = |away: f64| {
        let t = ((away.abs() - WHOLE_PX) / (CORE_PX - WHOLE_PX)).clamp(0.0, 1.0);
        let cosine = sin_cos(FRAC_PI_2 * t).1;
        cosine * cosine
    };
    along(offset_px.x) * along(offset_px.y)
}

/// The core at a position of the image for a wavelength, its sum one.
#[derive(Clone, Debug)]
pub(super) struct CoreTable {
    /// Mass of the cells, row by row.
    cells: Vec<f32>,
    /// Cumulative mass of all rows up to each row.
    rows: Vec<f32>,
    /// Cumulative mass of the row up to each cell.
    in_row: Vec<f32>,
}

/// A core during accumulation of mass.
#[derive(Debug)]
pub(super) struct CoreBuilder {
    cells: Vec<f64>,
}

impl Default for CoreBuilder {
    fn default() -> Self {
        Self { cells: vec![0.0; SIDE * SIDE] }
    }
}

impl CoreBuilder {
    /// Adds the core's fraction of a mass at an offset, px.
    pub(super) fn deposit(&mut self, offset: DVec2, mass: f64) {
        if offset.abs().max_element() >= CORE_PX {
            return;
        }
        let place = (offset + CORE_PX) * CELLS_PER_PX + 0.5;
        let (low, fraction) = (place.floor(), place - place.floor());
        let (x, y) = (low.x as usize, low.y as usize);
        let mass = mass * core_share(offset);
        for (row, tall) in [(y, 1.0 - fraction.y), (y + 1, fraction.y)] {
            self.cells[row * SIDE + x] += mass * tall * (1.0 - fraction.x);
            self.cells[row * SIDE + x + 1] += mass * tall * fraction.x;
        }
    }

    /// Mass of the core.
    pub(super) fn sum(&self) -> f64 {
        self.cells.iter().sum()
    }

    /// The core; `None` if no mass is in it.
    pub(super) fn table(self) -> Option<CoreTable> {
        let sum = self.sum();
        (sum > 0.0).then(|| CoreTable::normalised(&self.cells, sum))
    }
}

impl CoreTable {
    fn normalised(cells: &[f64], sum: f64) -> Self {
        let cells: Vec<f64> = cells.iter().map(|cell| cell / sum).collect();
        let running = |masses: &mut dyn Iterator<Item = f64>| -> Vec<f32> {
            masses
                .scan(0.0, |sum, mass| {
                    *sum += mass;
                    Some(*sum as f32)
                })
                .collect()
        };
        let rows = running(&mut cells.chunks_exact(SIDE).map(|row| row.iter().sum()));
        let in_row = cells.chunks_exact(SIDE).flat_map(|row| running(&mut row.iter().copied())).collect();
        Self { cells: cells.iter().map(|cell| *cell as f32).collect(), rows, in_row }
    }

    /// Samples an offset, px, with two numbers in [0, 1).
    pub(super) fn sample_offset(&self, u: DVec2) -> DVec2 {
        let (y, in_y) = invert(&self.rows, u.y);
        let (x, in_x) = invert(&self.in_row[y * SIDE..(y + 1) * SIDE], u.x);
        (DVec2::new(x as f64 + in_x, y as f64 + in_y) - 1.0) / CELLS_PER_PX - CORE_PX
    }

    /// The mass of the cell of an offset: the density, in units common to all tables.
    pub(super) fn density(&self, offset_px: DVec2) -> f64 {
        let place = ((offset_px + CORE_PX) * CELLS_PER_PX + 1.0).floor();
        let inside = place.min_element() >= 0.0 && place.max_element() < SIDE as f64;
        if inside { f64::from(self.cells[place.y as usize * SIDE + place.x as usize]) } else { 0.0 }
    }
}

/// The cell of a running sum in which a fraction `u` of the total ends, and the position within the cell, 0 to 1.
fn invert(running: &[f32], u: f64) -> (usize, f64) {
    let all = f64::from(running[running.len() - 1]);
    let target = u * all;
    let cell = running.partition_point(|sum| f64::from(*sum) <= target).min(running.len() - 1);
    let before = if cell == 0 { 0.0 } else { f64::from(running[cell - 1]) };
    let mass = f64::from(running[cell]) - before;
    (cell, if mass > 0.0 { ((target - before) / mass).clamp(0.0, 1.0) } else { 0.5 })
}
