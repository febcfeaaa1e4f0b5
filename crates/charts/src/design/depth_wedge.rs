//! Depth wedge: on the left a staircase of panels from near to far, on the right one slanted plane back from far to near, all
//! textured, in front of a wall. Measures depth by stereo, focus or a network; the depth of the ground truth is the reference.

use etendue_core::maths::f64::{exp, ln};
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use glam::{DMat3, DVec2, DVec3};
use rand::RngExt;
use serde_json::json;

use super::{BLEED, dead_leaves::leaves};
use crate::drawing::{Drawing, Patch, Texture};
use crate::ink::{Ink, Paint};
use crate::shape::{Sheet, rectangle};
use crate::{error::ChartError, light::Panel, ray_camera::Footprint};

/// Side of the texture, texels; tiles are mirrored.
const SIDE: usize = 1024;
/// Pixels per tile, in each direction: wider than a step, so that nothing repeats along a row of it.
const TILE_PX: f64 = 512.0;
/// Radii of its leaves, texels.
const RADII: [f64; 2] = [2.0, 120.0];
/// Distance of the wall relative to that of the farthest panel.
const WALL_DISTANCE: f64 = 1.25;
/// Overlap of a panel behind the nearer one, as a fraction of its width.
const OVERLAP: f64 = 0.05;

/// A staircase and a slanted plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthWedge {
    /// Steps of the staircase.
    pub steps: u32,
    /// Distance of the farthest panel relative to that of the nearest, which is at the chart's distance.
    pub far_ratio: f64,
}

impl DepthWedge {
    pub(super) fn draw(&self, footprint: &Footprint, seed: u64) -> Result<Drawing, ChartError> {
        if !(2..=100).contains(&self.steps) {
            return Err(ChartError::option("steps", self.steps, "expected 2 … 100 steps"));
        }
        if !(self.far_ratio > 1.0 && self.far_ratio <= 1000.0) {
            return Err(ChartError::option("far_ratio", self.far_ratio, "expected a ratio above 1 and up to 1000"));
        }
        // Half of the field relative to the distance: a point at tangent t and distance d is d t from the axis.
        let tangent = footprint.outer_mm * BLEED / (2e3 * footprint.distance_m);
        let distances_m = self.distances_m(footprint.distance_m);
        let mut panels = vec![wall(footprint.distance_m * self.far_ratio * WALL_DISTANCE, tangent)];
        let width = tangent.x / f64::from(self.steps);
        panels.extend(distances_m.iter().enumerate().map(|(i, distance_m)| {
            let from = -tangent.x + width * i as f64;
            step(i, *distance_m, from - if i == 0 { 0.0 } else { OVERLAP * width }, from + width, tangent.y)
        }));
        panels.push(slant(footprint.distance_m * self.far_ratio, footprint.distance_m, tangent));
        let mut drawing = Drawing::printed(panels.remove(0), Vec::new());
        drawing.panels.extend(panels);
        self.paint(&mut drawing, footprint, seed);
        drawing.note("steps_m", json!(distances_m));
        drawing.note("slant_m", json!([footprint.distance_m * self.far_ratio, footprint.distance_m]));
        drawing.note("wall_m", footprint.distance_m * self.far_ratio * WALL_DISTANCE);
        Ok(drawing)
    }

    /// Distances in equal ratios, nearest first.
    fn distances_m(&self, near_m: f64) -> Vec<f64> {
        let at = |i: u32| near_m * exp(ln(self.far_ratio) * f64::from(i) / f64::from(self.steps - 1));
        (0..self.steps).map(at).collect()
    }

    /// Paints each panel with a texture of its own scale, which has the same size in the image at every distance.
    fn paint(&self, drawing: &mut Drawing, footprint: &Footprint, seed: u64) {
        let (values, _) = leaves(SIDE, RADII[0], RADII[1], seed);
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64 / 65_535.0;
        let mut random = NoiseStream::new(seed, 0, 0, 0, Pixel { x: 1, y: 0 }, NoiseDraw::Shot);
        for (i, panel) in drawing.panels.iter_mut().enumerate() {
            let nearest_m = panel.position_m.x.min(panel.world_m(DVec2::new(panel.sheet.size_mm.x / 2.0, 0.0)).x);
            let tile = DVec2::splat(TILE_PX * footprint.pixel_mm * nearest_m / footprint.distance_m);
            let (name, file) = (format!("{}-texture", panel.name), "leaves.png".to_owned());
            // Every panel starts at another place of the texture, so that neighbours differ.
            let corner = -panel.sheet.size_mm / 2.0 - tile * DVec2::new(random.random(), random.random());
            let place_mm = (corner, corner + tile);
            let values = values.clone();
            drawing.textures.push(Texture {
                name,
                file,
                panel: i,
                position_mm: place_mm,
                width: SIDE,
                height: SIDE,
                values,
            });
            drawing.inks.push(Ink::new(panel.name.clone(), Paint::Texture { texture: i, mean }));
            let half = panel.sheet.size_mm / 2.0;
            panel.sheet = Sheet::plain(panel.sheet.size_mm, i);
            let outline_mm = rectangle(-half, half);
            drawing.patches.push(Patch { name: panel.name.clone(), panel: i, ink: i, outline_mm });
        }
    }
}

fn wall(distance_m: f64, tangent: DVec2) -> Panel {
    Panel::facing("wall", Sheet::new(2e3 * distance_m * tangent), distance_m)
}

/// A step that is visible between two tangents.
fn step(i: usize, distance_m: f64, from: f64, to: f64, upright: f64) -> Panel {
    let size = 1e3 * distance_m * DVec2::new(to - from, 2.0 * upright);
    let mut panel = Panel::facing(format!("step-{:02}", i + 1), Sheet::new(size), distance_m);
    panel.position_m.y = -distance_m * (from + to) / 2.0;
    panel
}

/// The plane from the image centre, far away, to its right edge, near.
fn slant(far_m: f64, near_m: f64, tangent: DVec2) -> Panel {
    let (start, end) = (DVec3::new(far_m, 0.0, 0.0), DVec3::new(near_m, -near_m * tangent.x, 0.0));
    let along = (end - start).normalize();
    let size = DVec2::new((end - start).length(), 2.0 * far_m * tangent.y) * 1e3;
    let rotation = DMat3::from_cols(along, DVec3::NEG_Z, along.cross(DVec3::NEG_Z));
    Panel { name: "slant".into(), sheet: Sheet::new(size), position_m: (start + end) / 2.0, rotation }
}
