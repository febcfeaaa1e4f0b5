//! Dots: black discs in a square lattice on white, over all of the field and beyond its edge (ISO 17850, ISO 19084, the paper's
//! figure 10). Measures focal length, distortion, chromatic displacement.
//!
//! Three dots near the centre are left out as orientation marks: one, one three columns to its right, and one two rows below it.
//! In a mirrored image the longer leg is on the other side of the shorter one, at any rotation and any position of the centre.
//! Charts of fewer than [`MIN_MARKED`] dots, or of too few rows and columns, have no marks: each dot counts there.
//!
//! Circles for calibration, all of them in view: a square lattice, or a staggered one (every other row shifted by half the
//! distance) that shows which side is up.
//!
//! Points: small lamps in the dark, far below a pixel in size or of a known size. Measures point-spread function, coma, chromatic
//! displacement.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::DVec2;

use super::{BLEED, GridSize, discs};
use crate::drawing::{Drawing, Feature, FeatureKind};
use crate::ink::{Ink, Paint};
use crate::shape::{CellContent, Fill, Lattice, ZoneFigure, disc};
use crate::{error::ChartError, light::Panel, ray_camera::Footprint};

/// Minimum number of dots of a chart with marks.
const MIN_MARKED: usize = 150;
/// Columns and rows from the first mark to the chart's centre, and from it to the other two.
const FIRST_MARK: [usize; 2] = [4, 3];
const LEGS: [usize; 2] = [3, 2];

/// A chart of dots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dots {
    /// Number and spacing. Default: 33 columns over the visible width, fewer if their steps would be less than 24 px at the image
    /// centre: each colour of a mosaic has every other pixel.
    pub size: GridSize,
    /// Diameter relative to the distance between centres, 0.05 … 0.9.
    pub dot_ratio: f64,
}

impl Dots {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(0.05..=0.9).contains(&self.dot_ratio) {
            return Err(ChartError::option("dot_ratio", self.dot_ratio, "expected 0.05 … 0.9"));
        }
        let grid =
            self.size.fit_into(footprint.outer_mm, usual_columns(footprint.outer_mm.x / footprint.pixel_mm), 3)?;
        let marks = marks(grid.columns, grid.rows);
        // Cells are numbered from 1.
        let is_dot = |column: usize, row: usize| !marks.contains(&[column.wrapping_sub(1), row.wrapping_sub(1)]);
        let mut drawing = discs::draw(footprint, &grid, self.dot_ratio, is_dot);
        drawing.note("columns", grid.columns);
        drawing.note("rows", grid.rows);
        drawing.note("left_out", marks.iter().map(|mark| mark.to_vec()).collect::<Vec<_>>());
        Ok(drawing)
    }
}

/// Column and row, from 0, of the omitted dots.
fn marks(columns: usize, rows: usize) -> Vec<[usize; 2]> {
    let middle = [columns / 2, rows / 2];
    // Each mark has dots on its four sides.
    let room = middle[0] > FIRST_MARK[0] && middle[1] > FIRST_MARK[1];
    if columns * rows < MIN_MARKED || !room {
        return Vec::new();
    }
    let [x, y] = [middle[0] - FIRST_MARK[0], middle[1] - FIRST_MARK[1]];
    vec![[x, y], [x + LEGS[0], y], [x, y + LEGS[1]]]
}

/// Columns for an image width in px: steps of 24 px if these leave six columns; otherwise six columns, with steps of 12 px or
/// more.
fn usual_columns(width_px: f64) -> u32 {
    const MAX_DOTS: f64 = 33.0;
    const MIN_DOTS: f64 = 6.0;
    const STEP_PX: f64 = 24.0;
    const MIN_STEP_PX: f64 = 12.0;
    // Rounding must not remove the last column.
    let fit = |step: f64| (width_px / step * (1.0 + 1e-9)).floor();
    fit(STEP_PX).max(fit(MIN_STEP_PX).min(MIN_DOTS)).clamp(3.0, MAX_DOTS) as u32
}

/// Size of the lattice relative to the fully visible rectangle.
const LATTICE_FRACTION: f64 = 0.92;
/// Diameter relative to the side of a circle's cell.
const DOT_FRACTION: f64 = 0.6;

/// A lattice of circles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circles {
    /// Number and spacing (for a staggered lattice: of the cells, of which every other one contains a circle).
    pub size: GridSize,
    /// True for a staggered lattice.
    pub asymmetric: bool,
}

impl Circles {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let columns = if self.asymmetric { 15 } else { 11 };
        let grid = self.size.fit_into(footprint.inner_mm * LATTICE_FRACTION, columns, 3)?;
        let is_dot = |column: usize, row: usize| !self.asymmetric || (column + row).is_multiple_of(2);
        let mut drawing = discs::draw(footprint, &grid, DOT_FRACTION, is_dot);
        drawing.note("cells", vec![grid.columns, grid.rows]);
        drawing.note("asymmetric", self.asymmetric);
        Ok(drawing)
    }
}

/// Corners of a lamp.
const CORNERS: usize = 16;

/// Small lamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points {
    /// Number and spacing. Default: 15 columns over the fully visible width.
    pub size: GridSize,
    /// Diameter of a lamp, in pixels at the image centre.
    pub diameter_px: f64,
}

impl Points {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(0.05..=10.0).contains(&self.diameter_px) {
            return Err(ChartError::option("diameter_px", self.diameter_px, "expected 0.05 … 10 px"));
        }
        let grid = self.size.fit_into(footprint.inner_mm, 15, 1)?;
        let radius = self.diameter_px * footprint.pixel_mm / 2.0;
        let lattice = Lattice::framed(grid.columns, grid.rows, DVec2::splat(grid.pitch_mm), footprint.outer_mm * BLEED);
        let mut features = Vec::new();
        let sheet = lattice.sheet(|column, row| {
            if !lattice.is_inside(column, row) {
                return CellContent::Plain(Fill::Ink(0));
            }
            let centre = lattice.middle(column, row);
            let lamp = Feature::at(FeatureKind::Point, [column - 1, row - 1], centre);
            features.push(Feature { radius_mm: Some(radius), ..lamp });
            CellContent::Figure(ZoneFigure::one(centre, disc(centre, radius, CORNERS, FRAC_PI_4), 1), Fill::Ink(0))
        });
        // A pixel that contains a whole lamp is as bright as if the light of the chart filled it.
        let fraction = 1.0 / (PI * self.diameter_px * self.diameter_px / 4.0).min(1.0);
        let inks = vec![Ink::new("dark", Paint::Luminous(0.0)), Ink::new("lamp", Paint::Luminous(fraction))];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        drawing.is_illuminated = false;
        drawing.features = features;
        drawing.note("points", vec![grid.columns, grid.rows]);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("diameter_mm", 2.0 * radius);
        drawing.note("diameter_px", self.diameter_px);
        drawing.spp = 256;
        Ok(drawing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_charts_have_marks() {
        assert_eq!(marks(33, 25), [[12, 9], [15, 9], [12, 11]]);
        assert!(marks(12, 9).is_empty() && marks(60, 6).is_empty());
    }

    #[test]
    fn steps_suit_the_measurement() {
        let columns = [4000.0, 800.0, 640.0, 160.0, 120.0, 80.0, 20.0].map(usual_columns);
        assert_eq!(columns, [33, 33, 26, 6, 6, 6, 3]);
    }
}
