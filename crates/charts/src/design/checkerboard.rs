//! A checkerboard, all of it in view: corners to calibrate with.

use super::{BLACK, BLEED, GridSize, WHITE};
use crate::drawing::{Drawing, Feature, Kind};
use crate::error::ChartError;
use crate::ink::Ink;
use crate::panel::Panel;
use crate::ray_camera::Footprint;
use crate::shape::{Cell, Fill, Lattice};
use glam::DVec2;

/// How much of what is wholly seen the board takes.
const ROOM: f64 = 0.92;

/// A checkerboard; `size` counts squares. Default: 12 columns of squares over the width that is wholly seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// How many squares, and how large.
    pub size: GridSize,
}

impl Checkerboard {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let grid = self.size.in_room(seen.inner_mm * ROOM, 12, 3)?;
        let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), seen.outer_mm * BLEED);
        let sheet = lattice.sheet(|column, row| {
            let black = lattice.is_inside(column, row) && (column + row) % 2 == 0;
            Cell::Plain(Fill::Ink(usize::from(black)))
        });
        let inks = vec![Ink::grey("white", WHITE), Ink::grey("black", BLACK)];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), inks);
        // The corners between squares: the lower right corners of all but the last columns and rows.
        let corners = (1..grid.rows).flat_map(|row| (1..grid.columns).map(move |column| (column, row)));
        let corner = |(column, row)| Feature::at(Kind::Corner, [column - 1, row - 1], lattice.cell(column, row)[2]);
        drawing.features = corners.map(corner).collect();
        drawing.note("squares", vec![grid.columns, grid.rows]);
        drawing.note("inner_corners", vec![grid.columns - 1, grid.rows - 1]);
        drawing.note("pitch_mm", grid.pitch_mm);
        Ok(drawing)
    }
}
