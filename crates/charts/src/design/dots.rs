//! Dots: black discs in a square lattice on white, over all of the field and beyond its edge (ISO 17850, ISO 19084, the paper's
//! figure 10). Focal length, distortion, chromatic displacement.

use super::{BLACK, BLEED, GridSize, WHITE};
use crate::drawing::{Drawing, Feature, Kind};
use crate::error::ChartError;
use crate::eye::Footprint;
use crate::ink::Ink;
use crate::panel::Panel;
use crate::shape::{Cell, Figure, Fill, Lattice, disc};

/// Corners of a dot: its outline leaves the circle by 2e-4 of its radius.
const CORNERS: usize = 128;

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
        let radius_mm = self.dot_share * grid.pitch_mm / 2.0;

        let lattice =
            Lattice::framed(grid.columns, grid.rows, glam::DVec2::splat(grid.pitch_mm), seen.outer_mm * BLEED);
        let mut features = Vec::new();
        let sheet = lattice.sheet(|column, row| {
            if !lattice.is_inside(column, row) {
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
        drawing.note("columns", grid.columns);
        drawing.note("rows", grid.rows);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("diameter_mm", 2.0 * radius_mm);
        Ok(drawing)
    }
}
