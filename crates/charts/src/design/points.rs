//! Points: small lamps in the dark, far below a pixel in size or of a size that is known. Point-spread function, coma, chromatic
//! displacement.

use super::{BLEED, GridSize};
use crate::drawing::{Drawing, Feature, Kind};
use crate::error::ChartError;
use crate::ink::{Ink, Paint};
use crate::panel::Panel;
use crate::ray_camera::Footprint;
use crate::shape::{Cell, Figure, Fill, Lattice, disc};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_4, PI};

/// Corners of a lamp.
const CORNERS: usize = 16;

/// Small lamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points {
    /// How many and how far apart. Default: 15 columns over what is wholly seen.
    pub size: GridSize,
    /// Diameter of a lamp, pixels of the picture's middle.
    pub diameter_px: f64,
}

impl Points {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(0.05..=10.0).contains(&self.diameter_px) {
            return Err(ChartError::option("diameter_px", self.diameter_px, "expected 0.05 … 10 px"));
        }
        let grid = self.size.in_room(seen.inner_mm, 15, 1)?;
        let radius = self.diameter_px * seen.pixel_mm / 2.0;
        let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), seen.outer_mm * BLEED);
        let mut features = Vec::new();
        let sheet = lattice.sheet(|column, row| {
            if !lattice.is_inside(column, row) {
                return Cell::Plain(Fill::Ink(0));
            }
            let centre = lattice.middle(column, row);
            let lamp = Feature::at(Kind::Point, [column - 1, row - 1], centre);
            features.push(Feature { radius_mm: Some(radius), ..lamp });
            Cell::Figure(Figure::one(centre, disc(centre, radius, CORNERS, FRAC_PI_4), 1), Fill::Ink(0))
        });
        // A pixel that holds a whole lamp is as bright as if the light of the chart filled it.
        let share = 1.0 / (PI * self.diameter_px * self.diameter_px / 4.0).min(1.0);
        let inks = vec![Ink::new("dark", Paint::Glow(0.0)), Ink::new("lamp", Paint::Glow(share))];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), inks);
        drawing.lit = false;
        drawing.features = features;
        drawing.note("points", vec![grid.columns, grid.rows]);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("diameter_mm", 2.0 * radius);
        drawing.note("diameter_px", self.diameter_px);
        drawing.spp = 256;
        Ok(drawing)
    }
}
