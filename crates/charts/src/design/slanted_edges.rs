//! Slanted edges over the field: dark squares, rotated by a small angle, each with two near-vertical and two near-horizontal
//! edges (ISO 12233). Measures spatial frequency response by position and direction.

use glam::DVec2;

use super::{BLEED, GridSize, angle, contrast, is_measurable};
use crate::drawing::{Drawing, Feature, Patch};
use crate::shape::{CellContent, Fill, Lattice, ZoneFigure, rectangle, rotated};
use crate::{error::ChartError, ink::Ink, light::Panel, ray_camera::Footprint};

/// Side of a square relative to the distance between centres.
const SIDE: f64 = 0.55;
/// Reflectance of the ground.
const LIGHT: f64 = 0.72;

/// Slanted squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlantedEdges {
    /// Number and spacing of the squares. Default: 5 columns over the fully visible width.
    pub size: GridSize,
    /// Clockwise rotation of the squares, degrees.
    pub angle_deg: f64,
    /// Luminance of the ground relative to the squares'.
    pub contrast: f64,
}

impl SlantedEdges {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let (angle_rad, contrast) = (angle(self.angle_deg)?, contrast(self.contrast)?);
        if !is_measurable(self.angle_deg) {
            let message = "expected 2 … 43 or -43 … -2: only such edges are sampled between the pixels (measure sfr)";
            return Err(ChartError::option("angle_deg", self.angle_deg, message));
        }
        let grid = self.size.fit_into(footprint.inner_mm, 5, 1)?;
        let pitch = DVec2::splat(grid.pitch_mm);
        let lattice = Lattice::framed(grid.columns, grid.rows, pitch, footprint.outer_mm * BLEED);
        let (mut features, mut patches) = (Vec::new(), Vec::new());
        let sheet = lattice.sheet(|column, row| {
            if !lattice.is_inside(column, row) {
                return CellContent::Plain(Fill::Ink(0));
            }
            let (centre, half) = (lattice.middle(column, row), DVec2::splat(SIDE * grid.pitch_mm / 2.0));
            let square = rotated(&rectangle(centre - half, centre + half), centre, angle_rad);
            let index = [column - 1, row - 1];
            features.extend((0..4).map(|i| Feature::edge(index, square[i], square[(i + 1) % 4])));
            let name = format!("square-{}-{}", index[0], index[1]);
            patches.push(Patch { name, panel: 0, ink: 1, outline_mm: square.clone() });
            CellContent::Figure(ZoneFigure::one(centre, square, 1), Fill::Ink(0))
        });
        let inks = vec![Ink::grey("light", LIGHT), Ink::grey("dark", LIGHT / contrast)];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        (drawing.features, drawing.patches) = (features, patches);
        drawing.note("squares", vec![grid.columns, grid.rows]);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("side_mm", SIDE * grid.pitch_mm);
        drawing.note("angle_deg", self.angle_deg);
        drawing.note("contrast", contrast);
        drawing.spp = 256;
        Ok(drawing)
    }
}
