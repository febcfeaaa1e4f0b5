//! Slanted stars: dark and light wedges around a centre, rotated so that no edge is vertical or horizontal; after the star of ISO
//! 12233:2023. Measures spatial frequency response in many directions, radial and tangential, at several positions.

use glam::DVec2;
use serde_json::json;

use super::{BLEED, GridSize, angle, contrast, is_measurable};
use crate::drawing::{Drawing, Feature, FeatureKind};
use crate::shape::{CellContent, Fill, Lattice, Zone, ZoneFigure, disc};
use crate::{error::ChartError, ink::Ink, light::Panel, ray_camera::Footprint};

/// Outer radius relative to the distance between centres.
const OUTER: f64 = 0.46;
/// Inner radius relative to the outer one.
const INNER: f64 = 0.12;
/// Reflectance of the light wedges and of the ground.
const LIGHT: f64 = 0.72;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlantedStar {
    /// Number and spacing of the stars. Default: 3 columns over the fully visible width.
    pub size: GridSize,
    /// Dark wedges.
    pub spokes: u32,
    /// Direction of the first edge from the horizontal, clockwise, degrees.
    pub angle_deg: f64,
    /// Luminance of light relative to dark.
    pub contrast: f64,
}

impl SlantedStar {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let (angle_rad, contrast) = (angle(self.angle_deg)?, contrast(self.contrast)?);
        if !(2..=36).contains(&self.spokes) {
            return Err(ChartError::option("spokes", self.spokes, "expected 2 … 36 dark wedges"));
        }
        let unmeasurable_deg = self.unmeasurable_deg();
        if unmeasurable_deg.len() == 2 * self.spokes as usize {
            let message =
                "no edge of these stars lies 2° to 43° off rows and columns: expected another angle or more spokes";
            return Err(ChartError::option("angle_deg", self.angle_deg, message));
        }
        let grid = self.size.fit_into(footprint.inner_mm, 3, 1)?;
        let pitch = DVec2::splat(grid.pitch_mm);
        let lattice = Lattice::framed(grid.columns, grid.rows, pitch, footprint.outer_mm * BLEED);
        let (outer, corners) = (OUTER * grid.pitch_mm, 2 * self.spokes as usize);
        let mut features = Vec::new();
        let sheet = lattice.sheet(|column, row| {
            if !lattice.is_inside(column, row) {
                return CellContent::Plain(Fill::Ink(0));
            }
            let (centre, index) = (lattice.middle(column, row), [column - 1, row - 1]);
            let [within, around] = [INNER * outer, outer].map(|radius| disc(centre, radius, corners, angle_rad));
            features.push(Feature::at(FeatureKind::Centre, index, centre));
            // Even corners begin a dark wedge, which is on the right of the outward direction (clockwise); odd ones end it.
            features.extend((0..corners).map(|i| match i % 2 {
                0 => Feature::edge(index, within[i], around[i]),
                _ => Feature::edge(index, around[i], within[i]),
            }));
            let wedges = (0..corners).map(|i| Fill::Ink(1 - i % 2)).collect();
            let zones = vec![Zone::even(within, 0), Zone { outline: around, fills: wedges }];
            CellContent::Figure(ZoneFigure { centre, zones }, Fill::Ink(0))
        });
        let inks = vec![Ink::grey("light", LIGHT), Ink::grey("dark", LIGHT / contrast)];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        drawing.features = features;
        drawing.note("stars", vec![grid.columns, grid.rows]);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("dark_wedges", self.spokes);
        drawing.note("radii_mm", json!([INNER * outer, outer]));
        drawing.note("angle_deg", self.angle_deg);
        drawing.note("contrast", contrast);
        drawing.note("unmeasurable_edges_deg", unmeasurable_deg);
        drawing.spp = 256;
        Ok(drawing)
    }

    /// Directions of the edges that are too near to rows, columns or diagonals, 0 … 360°.
    fn unmeasurable_deg(&self) -> Vec<f64> {
        let edges = 2 * self.spokes;
        let direction = |i: u32| (self.angle_deg + 360.0 * f64::from(i) / f64::from(edges)).rem_euclid(360.0);
        (0..edges).map(direction).filter(|deg| !is_measurable(*deg)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_along_rows_columns_and_diagonals_are_reported() {
        let star = |spokes: u32, angle_deg: f64| {
            SlantedStar { size: GridSize::default(), spokes, angle_deg, contrast: 4.0 }.unmeasurable_deg()
        };
        assert!(star(8, 5.0).is_empty());
        let eighths: Vec<f64> = (0..8).map(|i| 45.0 * f64::from(i)).collect();
        assert_eq!(star(8, 0.0), eighths);
        // Edges every 22.5° from -3.5°: 41.5°, 64°, 86.5°.
        assert!(star(8, -3.5).is_empty());
        assert_eq!(star(4, 1.0).len(), 8);
    }
}
