//! Dead leaves: overlapping discs with radii by the power law r⁻³ between limits and uniformly distributed greys, so that the
//! image has the statistics of natural scenes at every scale (after Lee, Mumford and Huang 2001; ISO 19567-2). Measures texture
//! loss.
//!
//! The leaves are placed from the top down: a texel takes the first leaf that covers it. The texture has several texels per pixel
//! in each direction; its numbers are reflectances.

use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use glam::DVec2;
use rand::RngExt;

use super::BLEED;
use crate::drawing::{Drawing, Patch, Texture};
use crate::ink::{Ink, Paint};
use crate::shape::{CellContent, Fill, Lattice, rectangle};
use crate::{error::ChartError, light::Panel, ray_camera::Footprint};

/// Side relative to the fully visible height.
const REACH: f64 = 0.8;
/// Texels per pixel, in each direction.
const TEXELS: f64 = 4.0;
/// Maximum side of a texture, texels.
const MAX_TEXELS: f64 = 6000.0;
/// Radius of the smallest leaf that the centre of a texel can be expected to sample, texels.
const MIN_RADIUS: f64 = 0.5;
/// Reflectance of the darkest and the lightest leaf.
const GREYS: (f64, f64) = (0.1, 0.7);

/// A chart of dead leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeadLeaves {
    /// Radius of the smallest leaves, in pixels at the image centre.
    pub smallest_px: f64,
    /// Radius of the largest leaves relative to the chart's side.
    pub largest_ratio: f64,
}

impl DeadLeaves {
    pub(super) fn draw(&self, footprint: &Footprint, seed: u64) -> Result<Drawing, ChartError> {
        let side = REACH * footprint.inner_mm.min_element();
        let texels = (TEXELS * side / footprint.pixel_mm).min(MAX_TEXELS).round().max(16.0);
        let (smallest, largest) = (self.smallest_px * footprint.pixel_mm / side, self.largest_ratio);
        if !(self.smallest_px > 0.0 && smallest < largest) {
            let message = "expected a radius above 0 px and below that of the largest leaves";
            return Err(ChartError::option("smallest_px", self.smallest_px, message));
        }
        if !(largest > 0.0 && largest <= 0.5) {
            return Err(ChartError::option(
                "largest_ratio",
                largest,
                "expected a fraction of the side, above 0 and at most 0.5",
            ));
        }
        if smallest * texels < MIN_RADIUS {
            let least_px = MIN_RADIUS * side / (texels * footprint.pixel_mm);
            let message = format!("leaves smaller than half a texel are not drawn: expected {least_px:.4} px or more");
            return Err(ChartError::option("smallest_px", self.smallest_px, message));
        }
        let half = DVec2::splat(side / 2.0);
        let (leaves, leaf_count) = leaves(texels as usize, smallest * texels, largest * texels, seed);
        let mean = leaves.iter().map(|v| f64::from(*v)).sum::<f64>() / leaves.len() as f64 / 65_535.0;
        let lattice = Lattice::framed(1, 1, 2.0 * half, footprint.outer_mm * BLEED);
        let sheet =
            lattice.sheet(|column, row| CellContent::Plain(Fill::Ink(usize::from(lattice.is_inside(column, row)))));
        let inks = vec![
            Ink::grey("ground", (GREYS.0 + GREYS.1) / 2.0),
            Ink::new("leaves", Paint::Texture { texture: 0, mean }),
        ];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        let outline_mm = rectangle(-half, half);
        let (width, height) = (texels as usize, texels as usize);
        let (name, file) = ("leaves".to_owned(), "leaves.png".to_owned());
        let place_mm = (-half, half);
        drawing.textures.push(Texture { name, file, panel: 0, position_mm: place_mm, width, height, values: leaves });
        drawing.patches.push(Patch { name: "leaves".into(), panel: 0, ink: 1, outline_mm });
        drawing.note("side_mm", side);
        drawing.note("texels_of_a_pixel", texels * footprint.pixel_mm / side);
        drawing.note("radii_mm", vec![smallest * side, largest * side]);
        drawing.note("reflectances", vec![GREYS.0, GREYS.1]);
        drawing.note("leaves", leaf_count);
        Ok(drawing)
    }
}

/// A square of leaves, and the number of leaves placed; radii in texels.
pub(super) fn leaves(side: usize, smallest: f64, largest: f64, seed: u64) -> (Vec<u16>, u64) {
    let mut random = NoiseStream::new(seed, 0, 0, 0, Pixel { x: 0, y: 0 }, NoiseDraw::Shot);
    let mut values = vec![None::<u16>; side * side];
    let (mut open, mut leaf_count) = (values.len(), 0);
    let [small, large] = [smallest, largest].map(|r| 1.0 / (r * r));
    while open > 0 {
        // Density r⁻³: 1/r² is uniform between its limits.
        let radius = 1.0 / (small - random.random::<f64>() * (small - large)).sqrt();
        let mut place = || random.random_range(-largest..side as f64 + largest);
        let centre = DVec2::new(place(), place());
        let grey = random.random_range(GREYS.0..GREYS.1);
        open -= place_leaf(&mut values, side, centre, radius, (grey * 65_535.0).round() as u16);
        leaf_count += 1;
    }
    (values.into_iter().map(|v| v.expect("all are covered")).collect(), leaf_count)
}

/// Assigns a leaf's grey to the unassigned texels under it; returns their number.
fn place_leaf(values: &mut [Option<u16>], side: usize, centre: DVec2, radius: f64, grey: u16) -> usize {
    // Texels by their centres.
    let range = |middle: f64, reach: f64| {
        let first = (middle - reach - 0.5).ceil().max(0.0) as usize;
        let end = (middle + reach + 0.5).floor().clamp(0.0, side as f64) as usize;
        first..end
    };
    let mut covered = 0;
    for y in range(centre.y, radius) {
        let off = y as f64 + 0.5 - centre.y;
        let reach = (radius * radius - off * off).max(0.0).sqrt();
        for x in range(centre.x, reach) {
            let value = &mut values[y * side + x];
            covered += usize::from(value.is_none());
            value.get_or_insert(grey);
        }
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_cover_the_square_with_the_requested_greys() {
        let (values, leaf_count) = leaves(200, 2.0, 40.0, 7);
        let greys: Vec<f64> = values.iter().map(|v| f64::from(*v) / 65_535.0).collect();
        assert!(leaf_count > 100 && greys.iter().all(|g| (0.0999..0.7001).contains(g)));
        assert_eq!(leaves(200, 2.0, 40.0, 7).0, values);
        assert_ne!(leaves(200, 2.0, 40.0, 8).0, values);
        // A texel and its neighbour show different leaves with a probability of about 2 ⟨r⟩/⟨r²⟩ · 2/π: far from never, far from
        // always.
        let changes = values.windows(2).filter(|w| w[0] != w[1]).count();
        assert!((1000..16_000).contains(&changes), "{changes}");
    }

    /// The digest is FNV-1a of the values' bytes, little-endian.
    #[test]
    fn leaves_of_a_seed_are_the_same_in_every_version_of_rand() {
        let (values, leaf_count) = leaves(32, 1.0, 8.0, 3);
        let bytes = values.iter().flat_map(|value| value.to_le_bytes());
        let digest = bytes
            .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        assert_eq!((leaf_count, digest), (1007, 0x0589_e092_cf3d_3aa6), "{digest:#x}");
    }
}
