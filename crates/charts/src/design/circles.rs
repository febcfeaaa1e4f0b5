//! Circles to calibrate with, all of them in view: a square lattice, or a staggered one (every other row shifted by half of
//! the distance) that shows which side is up.

use super::{BLACK, BLEED, GridSize, WHITE};
use crate::drawing::{Drawing, Feature, Kind};
use crate::error::ChartError;
use crate::eye::Footprint;
use crate::ink::Ink;
use crate::panel::Panel;
use crate::shape::{Cell, Figure, Fill, Lattice, disc};
use glam::DVec2;

/// How much of what is wholly seen the lattice takes.
const ROOM: f64 = 0.92;
/// Corners of a circle.
const CORNERS: usize = 128;
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
    pub(super) fn draw(&self, seen: &Footprint) -> Result<Drawing, ChartError> {
        let columns = if self.asymmetric { 15 } else { 11 };
        let grid = self.size.in_room(seen.inner_mm * ROOM, columns, 3)?;
        let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), seen.outer_mm * BLEED);
        let radius_mm = DOT_SHARE * grid.pitch_mm / 2.0;
        let mut features = Vec::new();
        let sheet = lattice.sheet(|column, row| {
            let here = !self.asymmetric || (column + row) % 2 == 0;
            if !(here && lattice.is_inside(column, row)) {
                return Cell::Plain(Fill::Ink(0));
            }
            let centre = lattice.middle(column, row);
            let dot = Feature::at(Kind::Dot, [column - 1, row - 1], centre);
            features.push(Feature { radius_mm: Some(radius_mm), ..dot });
            let outline = disc(centre, radius_mm, CORNERS, std::f64::consts::FRAC_PI_4);
            Cell::Figure(Figure::one(centre, outline, 1), Fill::Ink(0))
        });
        let inks = vec![Ink::grey("white", WHITE), Ink::grey("black", BLACK)];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), inks);
        drawing.features = features;
        drawing.note("cells", vec![grid.columns, grid.rows]);
        drawing.note("asymmetric", self.asymmetric);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("diameter_mm", 2.0 * radius_mm);
        Ok(drawing)
    }
}
