//! Black discs in the cells of a square lattice on white: shared by dots and circles.

use core::f64::consts::FRAC_PI_4;

use glam::DVec2;

use super::{BLACK, BLEED, WHITE, checkerboard::Grid};
use crate::drawing::{Drawing, Feature, FeatureKind};
use crate::shape::{CellContent, Fill, Lattice, ZoneFigure, disc};
use crate::{ink::Ink, light::Panel, ray_camera::Footprint};

/// Corners of a disc: its outline departs from the circle by 2e-4 of its radius.
const CORNERS: usize = 128;

/// Discs of a diameter (a fraction of the distance between cells) in the cells of a grid that `here` selects by column and row;
/// the white extends beyond the edge of the image.
pub(super) fn draw(
    footprint: &Footprint,
    grid: &Grid,
    dot_fraction: f64,
    includes: impl Fn(usize, usize) -> bool,
) -> Drawing {
    let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), footprint.outer_mm * BLEED);
    let radius_mm = dot_fraction * grid.pitch_mm / 2.0;
    let mut features = Vec::new();
    let sheet = lattice.sheet(|column, row| {
        if !(includes(column, row) && lattice.is_inside(column, row)) {
            return CellContent::Plain(Fill::Ink(0));
        }
        let centre = lattice.middle(column, row);
        let dot = Feature::at(FeatureKind::Dot, [column - 1, row - 1], centre);
        features.push(Feature { radius_mm: Some(radius_mm), ..dot });
        let outline = disc(centre, radius_mm, CORNERS, FRAC_PI_4);
        CellContent::Figure(ZoneFigure::one(centre, outline, 1), Fill::Ink(0))
    });
    let inks = vec![Ink::grey("white", WHITE), Ink::grey("black", BLACK)];
    let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
    drawing.features = features;
    drawing.note("pitch_mm", grid.pitch_mm);
    drawing.note("diameter_mm", 2.0 * radius_mm);
    drawing
}
