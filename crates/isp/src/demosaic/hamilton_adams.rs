//! Adaptive interpolation along the smaller gradient (Hamilton & Adams 1997, "Adaptive color plan interpolation in single
//! sensor color electronic camera", US patent 5 629 734, expired).
//!
//! 1. Green at a red or blue pixel C: of the two directions the one with the smaller
//!    |G₋₁ − G₊₁| + |2 C₀ − C₋₂ − C₊₂| gives (G₋₁ + G₊₁)/2 + (2 C₀ − C₋₂ − C₊₂)/4; of equal ones the mean.
//! 2. Red and blue at green pixels: the mean of the two neighbours plus half the second difference of green along them.
//! 3. Blue at red and red at blue: the same along the diagonal of the smaller |C₋₁ − C₊₁| + |2 G₀ − G₋₁ − G₊₁|.
//!
//! The picture is mirrored about its outermost pixels. Beside edges values can leave the range of the neighbours.

use super::padded::Padded;
use crate::mosaic::Tile;
use rayon::prelude::*;

/// How far the method reaches, px: green to 2, then the others 1 more.
pub(super) const MARGIN: usize = 3;

const GREEN: usize = 1;

pub(super) fn demosaic(samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; 3]> {
    let mosaic = Padded::new(samples, width, MARGIN);
    let mut green = vec![0.0; samples.len()];
    green.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let rows = [-2, -1, 0, 1, 2].map(|dy| mosaic.row(y, dy));
        for (x, g) in out.iter_mut().enumerate() {
            let at = x + MARGIN;
            *g = if tile.at(x, y) == GREEN { rows[2][at] } else { green_at(&rows, at) };
        }
    });
    // Mirrored greens are the greens of the mirrored picture: the method is symmetric.
    let padded = Padded::new(&green, width, MARGIN);
    drop(green);
    let mut plane = vec![[0.0; 3]; samples.len()];
    plane.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let around =
            Around { mosaic: [-1, 0, 1].map(|dy| mosaic.row(y, dy)), green: [-1, 0, 1].map(|dy| padded.row(y, dy)) };
        for (x, rgb) in out.iter_mut().enumerate() {
            *rgb = around.colours(x + MARGIN, tile.at(x, y), tile.at(x + 1, y));
        }
    });
    plane
}

/// Step 1.
fn green_at(rows: &[&[f32]; 5], x: usize) -> f32 {
    let [above2, above, row, below, below2] = rows;
    let along_row = Estimate::new(row[x - 1], row[x + 1], second(row[x - 2], row[x], row[x + 2]), 0.25);
    let along_column = Estimate::new(above[x], below[x], second(above2[x], row[x], below2[x]), 0.25);
    better(along_row, along_column)
}

/// Twice the middle less both sides.
fn second(before: f32, middle: f32, after: f32) -> f32 {
    2.0 * middle - before - after
}

/// A value along one direction, and how much the picture changes along it.
struct Estimate {
    value: f32,
    change: f32,
}

impl Estimate {
    fn new(before: f32, after: f32, second: f32, weight: f32) -> Self {
        Self { value: 0.5 * (before + after) + weight * second, change: (before - after).abs() + second.abs() }
    }
}

fn better(a: Estimate, b: Estimate) -> f32 {
    if a.change < b.change {
        a.value
    } else if b.change < a.change {
        b.value
    } else {
        0.5 * (a.value + b.value)
    }
}

/// Three rows about a pixel, of the mosaic and of green.
struct Around<'a> {
    mosaic: [&'a [f32]; 3],
    green: [&'a [f32]; 3],
}

impl Around<'_> {
    /// Steps 2 and 3, at a pixel of colour `own` with `beside` in its row.
    fn colours(&self, x: usize, own: usize, beside: usize) -> [f32; 3] {
        let mut rgb = [0.0; 3];
        rgb[own] = self.mosaic[1][x];
        if own == GREEN {
            rgb[beside] = self.along([(1, x - 1), (1, x + 1)], x).value;
            rgb[2 - beside] = self.along([(0, x), (2, x)], x).value;
        } else {
            rgb[GREEN] = self.green[1][x];
            let falling = self.along([(0, x - 1), (2, x + 1)], x);
            rgb[2 - own] = better(falling, self.along([(0, x + 1), (2, x - 1)], x));
        }
        rgb
    }

    /// The mean of two pixels on both sides of x, plus half the second difference of green.
    fn along(&self, [before, after]: [(usize, usize); 2], x: usize) -> Estimate {
        let (c, g) = (|(r, x): (usize, usize)| self.mosaic[r][x], |(r, x): (usize, usize)| self.green[r][x]);
        Estimate::new(c(before), c(after), second(g(before), g((1, x)), g(after)), 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{Blue, Green, Red};
    use crate::mosaic::Mosaic;

    #[test]
    fn a_grey_edge_along_the_pixels_is_exact() {
        let Ok(Mosaic::Tile(tile)) = Mosaic::tile(2, 2, vec![Green, Red, Blue, Green]) else { unreachable!("Bayer") };
        let upright: Vec<f32> = (0..144).map(|i| if i % 12 < 6 { 0.25 } else { 0.75 }).collect();
        let level: Vec<f32> = (0..144).map(|i| if i / 12 < 7 { 0.25 } else { 0.75 }).collect();
        for edge in [upright, level] {
            let plane = demosaic(&edge, 12, &tile);
            // Green is interpolated along the edge, so it is exact. Red and blue follow it at half their places.
            assert!((0..144).all(|i| plane[i][GREEN] == edge[i]));
            let exact = (0..144).filter(|i| plane[*i] == [edge[*i]; 3]).count();
            assert!(exact == 144, "{exact} of 144");
        }
    }
}
