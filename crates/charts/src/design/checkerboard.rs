//! Charts of points: checkerboards and grids of dots.

use glam::DVec2;

use super::{BLACK, BLEED, WHITE};
use crate::drawing::{Drawing, Feature, FeatureKind};
use crate::shape::{CellContent, Fill, Lattice};
use crate::{error::ChartError, ink::Ink, light::Panel, ray_camera::Footprint};

/// Size of the board relative to the fully visible rectangle.
const BOARD_FRACTION: f64 = 0.92;

/// A checkerboard; `size` counts squares. Default: 12 columns of squares over the fully visible width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// Number and size of the squares.
    pub size: GridSize,
}

impl Checkerboard {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let grid = self.size.fit_into(footprint.inner_mm * BOARD_FRACTION, 12, 3)?;
        let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), footprint.outer_mm * BLEED);
        let sheet = lattice.sheet(|column, row| {
            let black = lattice.is_inside(column, row) && (column + row) % 2 == 0;
            CellContent::Plain(Fill::Ink(usize::from(black)))
        });
        let inks = vec![Ink::grey("white", WHITE), Ink::grey("black", BLACK)];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        // The corners between squares: the lower right corners of all but the last columns and rows.
        let corners = (1..grid.rows).flat_map(|row| (1..grid.columns).map(move |column| (column, row)));
        let corner =
            |(column, row)| Feature::at(FeatureKind::Corner, [column - 1, row - 1], lattice.cell(column, row)[2]);
        drawing.features = corners.map(corner).collect();
        drawing.note("squares", vec![grid.columns, grid.rows]);
        drawing.note("inner_corners", vec![grid.columns - 1, grid.rows - 1]);
        drawing.note("pitch_mm", grid.pitch_mm);
        Ok(drawing)
    }
}

/// Size of a lattice of figures; omitted values follow from the available space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridSize {
    pub columns: Option<u32>,
    pub rows: Option<u32>,
    /// Distance from centre to centre, mm.
    pub pitch_mm: Option<f64>,
}

/// Columns, rows and pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) pitch_mm: f64,
}

/// Maximum columns or rows; more are taken for a typing error.
const MAX_GRID: u32 = 500;

impl GridSize {
    /// The grid in a space (mm): as many of `columns` as the pitch allows, or the pitch that `columns` allow.
    pub(super) fn fit_into(self, room_mm: DVec2, columns: u32, min_columns: u32) -> Result<Grid, ChartError> {
        let checked = |option, count: Option<u32>| match count {
            Some(n) if !(min_columns..=MAX_GRID).contains(&n) => {
                Err(ChartError::option(option, n, format!("expected {min_columns} … {MAX_GRID}")))
            }
            count => Ok(count),
        };
        let (given_columns, given_rows) = (checked("columns", self.columns)?, checked("rows", self.rows)?);
        let pitch_mm = match (self.pitch_mm, given_columns, given_rows) {
            (Some(pitch), ..) if !(pitch.is_finite() && pitch > 0.0) => {
                return Err(ChartError::option("pitch_mm", pitch, "expected a distance above 0 mm"));
            }
            (Some(pitch), ..) => pitch,
            (None, Some(x), Some(y)) => (room_mm / DVec2::new(f64::from(x), f64::from(y))).min_element(),
            (None, None, Some(y)) => room_mm.y / f64::from(y),
            (None, x, None) => room_mm.x / f64::from(x.unwrap_or(columns)),
        };
        // Rounding must not remove the last column.
        let fit = |room: f64| (room / pitch_mm * (1.0 + 1e-9)).floor().min(f64::from(MAX_GRID)) as u32;
        let count = |count_option: Option<u32>, room: f64| count_option.unwrap_or_else(|| fit(room));
        let (columns, rows) = (count(given_columns, room_mm.x), count(given_rows, room_mm.y));
        if columns < min_columns || rows < min_columns {
            let message = format!(
                "this leaves {columns} columns and {rows} rows in view, but {min_columns} are needed; give a smaller value"
            );
            return Err(ChartError::option("pitch_mm", format!("{pitch_mm:.3}"), message));
        }
        Ok(Grid { columns: columns as usize, rows: rows as usize, pitch_mm })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_open_follows_from_the_room() {
        let room = DVec2::new(400.0, 300.0);
        let grid = |size: GridSize| size.fit_into(room, 40, 3).map(|g| (g.columns, g.rows, g.pitch_mm));
        assert_eq!(grid(GridSize::default()), Ok((40, 30, 10.0)));
        assert_eq!(grid(GridSize { pitch_mm: Some(20.0), ..GridSize::default() }), Ok((20, 15, 20.0)));
        assert_eq!(grid(GridSize { columns: Some(10), rows: Some(10), ..GridSize::default() }), Ok((10, 10, 30.0)));
        assert_eq!(grid(GridSize { rows: Some(6), ..GridSize::default() }), Ok((8, 6, 50.0)));
        assert!(grid(GridSize { pitch_mm: Some(200.0), ..GridSize::default() }).is_err());
        assert!(grid(GridSize { columns: Some(2), ..GridSize::default() }).is_err());
        assert!(grid(GridSize { pitch_mm: Some(f64::NAN), ..GridSize::default() }).is_err());
    }
}
