//! A sheet: pieces that partition a rectangle.

use super::outline::rectangle;
use glam::DVec2;

/// What a piece is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// Printed with an ink, by its place in the drawing's list.
    Ink(usize),
    /// Not there.
    Hole,
}

/// A convex piece of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its corners, mm, clockwise as seen.
    pub outline: Vec<DVec2>,
    /// What it is.
    pub fill: Fill,
}

/// A rectangle about the origin, partitioned.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Width and height, mm.
    pub size_mm: DVec2,
    /// The pieces.
    pub pieces: Vec<Piece>,
}

impl Sheet {
    /// A sheet without pieces yet.
    #[must_use]
    pub fn new(size_mm: DVec2) -> Self {
        Self { size_mm, pieces: Vec::new() }
    }

    /// A sheet of one ink.
    #[must_use]
    pub fn plain(size_mm: DVec2, ink: usize) -> Self {
        let mut sheet = Self::new(size_mm);
        sheet.add(rectangle(-size_mm / 2.0, size_mm / 2.0), Fill::Ink(ink));
        sheet
    }

    /// Adds a piece.
    pub fn add(&mut self, outline: Vec<DVec2>, fill: Fill) {
        self.pieces.push(Piece { outline, fill });
    }
}
