//! Pixels that are not read.

use crate::cfa::Cfa;
use etendue_core::Plane;
use etendue_core::quantity::Quantity;

/// Pixels that are not read: of so many tiles of the colour filter array only the first is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skipping {
    /// Tiles beside each other.
    pub columns: usize,
    /// Tiles below each other.
    pub rows: usize,
}

impl Skipping {
    /// The samples that are read.
    pub(crate) fn of<Q: Quantity>(&self, cfa: &Cfa, plane: &Plane<Q>) -> Plane<Q> {
        let (width, height) = (plane.width() / self.columns, plane.height() / self.rows);
        let row = |y: usize| {
            let y = first_of(y, cfa.height(), self.rows);
            (0..width).map(move |x| plane.at(first_of(x, cfa.width(), self.columns), y))
        };
        Plane::from_samples(width, height, (0..height).flat_map(row).collect()).expect("whole tiles")
    }
}

/// The first of the columns, or rows, of the array that column, or row, `i` of the result is made of, `n` of them in one, in tiles of a length.
pub(super) fn first_of(i: usize, tile: usize, n: usize) -> usize {
    i / tile * tile * n + i % tile
}
