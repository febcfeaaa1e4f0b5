//! Black discs in the cells of a square lattice on white: shared by dots and circles.

use core::f64::consts::FRAC_PI_4;

use glam::DVec2;

use super::{BLACK, BLEED, WHITE, checkerboard::Grid};
use crate::drawing::{Drawing, Feature, Kind};
use crate::shape::{Cell, Figure, Fill, Lattice, disc};
use crate::{ink::Ink, light::Panel, ray_camera::Footprint};

/// Corners of a disc: its outline departs from the circle by 2e-4 of its radius.
const CORNERS: usize = 128;

/// Discs of a diameter (a fraction of the distance between cells) in the cells of a grid that `here` selects by column and row;
/// the white extends beyond the edge of the image.
pub(super) fn draw(seen: &Footprint, grid: &Grid, share: f64, here: impl Fn(usize, usize) -> bool) -> Drawing {
    let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), seen.outer_mm * BLEED);
    let radius_mm = share * grid.pitch_mm / 2.0;
    let mut features = Vec::new();
    let sheet = lattice.sheet(|column, row| {
        if !(here(column, row) && lattice.is_inside(column, row)) {
            return Cell::Plain(Fill::Ink(0));
        }
        let centre = lattice.middle(column, row);
        let dot = Feature::at(Kind::Dot, [column - 1, row - 1], centre);
        features.push(Feature { radius_mm: Some(radius_mm), ..dot });
        let outline = disc(centre, radius_mm, CORNERS, FRAC_PI_4);
        Cell::Figure(Figure::one(centre, outline, 1), Fill::Ink(0))
    });
    let inks = vec![Ink::grey("white", WHITE), Ink::grey("black", BLACK)];
    let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), inks);
    drawing.features = features;
    drawing.note("pitch_mm", grid.pitch_mm);
    drawing.note("diameter_mm", 2.0 * radius_mm);
    drawing
}
