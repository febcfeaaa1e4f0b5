//! A lattice of rectangular cells that covers a sheet.

use super::figure::Figure;
use super::outline::rectangle;
use super::sheet::{Fill, Sheet};
use glam::DVec2;

/// What a cell of a lattice holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// One fill.
    Plain(Fill),
    /// A figure on a ground.
    Figure(Figure, Fill),
}

/// The lines of a lattice, the sheet's borders the first and the last of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    xs: Vec<f64>,
    ys: Vec<f64>,
}

impl Lattice {
    /// A lattice by its rising lines, two or more each way, mm.
    #[must_use]
    pub fn new(xs: Vec<f64>, ys: Vec<f64>) -> Self {
        let rising = |v: &[f64]| v.len() > 1 && v.windows(2).all(|w| w[0] < w[1]);
        assert!(rising(&xs) && rising(&ys), "lines of a lattice rise: {xs:?} {ys:?}");
        Self { xs, ys }
    }

    /// `columns` × `rows` cells of `pitch` about the origin, numbered from 1, and a margin around them, numbered 0 and last,
    /// up to a sheet of `size` or 2 % larger than the cells.
    #[must_use]
    pub fn framed(columns: usize, rows: usize, pitch: DVec2, size: DVec2) -> Self {
        let lines = |count: usize, pitch: f64, size: f64| {
            let first = -pitch * count as f64 / 2.0;
            let edge = (size / 2.0).max(-first * 1.02);
            let inside = (0..=count).map(|i| first + pitch * i as f64);
            [-edge].into_iter().chain(inside).chain([edge]).collect()
        };
        Self::new(lines(columns, pitch.x, size.x), lines(rows, pitch.y, size.y))
    }

    /// Whether a cell of a framed lattice is none of its margin.
    #[must_use]
    pub fn is_inside(&self, column: usize, row: usize) -> bool {
        (1..self.columns() - 1).contains(&column) && (1..self.rows() - 1).contains(&row)
    }

    /// Columns of cells.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.xs.len() - 1
    }

    /// Rows of cells.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.ys.len() - 1
    }

    /// The corners of a cell.
    #[must_use]
    pub fn cell(&self, column: usize, row: usize) -> Vec<DVec2> {
        let low = DVec2::new(self.xs[column], self.ys[row]);
        rectangle(low, DVec2::new(self.xs[column + 1], self.ys[row + 1]))
    }

    /// The middle of a cell.
    #[must_use]
    pub fn middle(&self, column: usize, row: usize) -> DVec2 {
        let mean = |lines: &[f64], i: usize| (lines[i] + lines[i + 1]) / 2.0;
        DVec2::new(mean(&self.xs, column), mean(&self.ys, row))
    }

    /// The sheet, by what each cell (column, row) holds.
    #[must_use]
    pub fn sheet(&self, mut of: impl FnMut(usize, usize) -> Cell) -> Sheet {
        let size = DVec2::new(self.xs[self.columns()] - self.xs[0], self.ys[self.rows()] - self.ys[0]);
        let mut sheet = Sheet::new(size);
        for row in 0..self.rows() {
            for column in 0..self.columns() {
                let outline = self.cell(column, row);
                match of(column, row) {
                    Cell::Plain(fill) => sheet.add(outline, fill),
                    Cell::Figure(figure, ground) => sheet.pieces.extend(figure.pieces(&outline, ground)),
                }
            }
        }
        sheet
    }
}
