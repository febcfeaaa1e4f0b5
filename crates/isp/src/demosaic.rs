//! Demosaic: interpolation of the colours that a pixel did not measure from its neighbours.
//!
//! | method | mosaics | reach |
//! | --- | --- | --- |
//! | [`Demosaic::Bilinear`] | all | the tile's reach |
//! | [`Demosaic::MalvarHeCutler`] | Bayer | 2 px |
//! | [`Demosaic::HamiltonAdams`] | Bayer | 3 px |
//!
//! Weighted means of neighbours.
//!
//! A pixel keeps the colour it measured. Each other colour is the weighted mean of the neighbours within the tile's reach r (one for tiles of two by
//! two) that measured it, with weights (r + 1 − |Δx|)(r + 1 − |Δy|): 2 for adjacent and 1 for diagonal neighbours for r = 1. On a Bayer tile this is
//! bilinear interpolation, and a linear ramp is reproduced exactly in the interior. At the image's edge the mean is over the existing neighbours.
//!
//! Gradient-corrected linear interpolation (Malvar, He & Cutler 2004, "High-quality linear interpolation for demosaicing of
//! Bayer-patterned color images", ICASSP).
//!
//! The bilinear value of the missing colour plus α, β or γ times the second difference of the measured colour: it assumes that peaks of one colour
//! are peaks of the others. With the paper's α = 1/2, β = 5/8, γ = 3/4 (the optimum over its images, rounded to eighths) these are four filters of
//! five by five, in eighths:
//!
//! | wanted | at | its own | same row ±1 | same column ±1 | diagonals | same row ±2 | same column ±2 |
//! | --- | --- | --- | --- | --- | --- | --- | --- |
//! | green | red, blue | 4 | 2 | 2 | 0 | −1 | −1 |
//! | the row's other colour | green | 5 | 4 | 0 | −1 | −1 | ½ |
//! | the column's other colour | green | 5 | 0 | 4 | −1 | ½ | −1 |
//! | blue, red | red, blue | 6 | 0 | 0 | 2 | −3/2 | −3/2 |
//!
//! The image is mirrored about its outermost pixels. Near edges values can leave the range of the neighbours.
//!
//! Adaptive interpolation along the smaller gradient (Hamilton & Adams 1997, "Adaptive color plan interpolation in single
//! sensor color electronic camera", US patent 5 629 734, expired).
//!
//! 1. Green at a red or blue pixel C: of the two directions the one with the smaller
//!    |G₋₁ − G₊₁| + |2 C₀ − C₋₂ − C₊₂| gives (G₋₁ + G₊₁)/2 + (2 C₀ − C₋₂ − C₊₂)/4; of equal ones the mean.
//! 2. Red and blue at green pixels: the mean of the two neighbours plus half the second difference of green along them.
//! 3. Blue at red and red at blue: the same along the diagonal of the smaller |C₋₁ − C₊₁| + |2 G₀ − G₋₁ − G₊₁|.
//!
//! The image is mirrored about its outermost pixels. Near edges values can leave the range of the neighbours.

#[cfg(test)]
mod tests;

use rayon::prelude::*;

use crate::raw::{Mosaic, Tile};

/// Method of colour interpolation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Demosaic {
    /// The weighted mean of the neighbours of each colour.
    #[default]
    Bilinear,
    /// Bilinear, corrected by the second difference of the measured colour.
    MalvarHeCutler,
    /// Along the direction of the smaller gradient.
    HamiltonAdams,
}

impl Demosaic {
    /// The smallest image side, px, for the method.
    #[must_use]
    pub fn min_size_px(self, mosaic: &Mosaic) -> usize {
        match (self, mosaic) {
            (_, Mosaic::Mono) => 0,
            (Self::Bilinear, Mosaic::Tile(tile)) => tile.reach() + 1,
            (Self::MalvarHeCutler, _) => MALVAR_MARGIN + 1,
            (Self::HamiltonAdams, _) => HAMILTON_ADAMS_MARGIN + 1,
        }
    }

    /// All `N` channels at every pixel. The caller has checked that the method fits the tile. Runs in the rayon pool of the caller; the result does
    /// not depend on it.
    pub(crate) fn apply<const N: usize>(self, samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; N]> {
        let three = |rgb: Vec<[f32; 3]>| rgb.into_iter().map(|v| core::array::from_fn(|c| v[c])).collect();
        match self {
            Self::Bilinear => interpolate_bilinear(samples, width, tile),
            Self::MalvarHeCutler => three(interpolate_malvar(samples, width, tile)),
            Self::HamiltonAdams => three(interpolate_hamilton_adams(samples, width, tile)),
        }
    }
}

/// Samples with a margin on all sides.
struct PaddedRow {
    samples: Vec<f32>,
    stride: usize,
    margin: usize,
}

impl PaddedRow {
    /// Needs at least `margin + 1` columns and rows.
    fn new(samples: &[f32], width: usize, margin: usize) -> Self {
        let (height, stride) = (samples.len() / width, width + 2 * margin);
        let mut padded = Vec::with_capacity(stride * (height + 2 * margin));
        for y in 0..height + 2 * margin {
            let row = &samples[mirrored(y, margin, height) * width..][..width];
            padded.extend((1..=margin).rev().map(|x| row[x]));
            padded.extend_from_slice(row);
            padded.extend((2..=margin + 1).map(|x| row[width - x]));
        }
        Self { samples: padded, stride, margin }
    }

    /// The row `dy` away from row `y`, margins included: column x is at x + margin.
    fn row(&self, y: usize, dy: isize) -> &[f32] {
        let row = (y + self.margin).wrapping_add_signed(dy);
        &self.samples[row * self.stride..][..self.stride]
    }
}

/// The row of the image shown by row `y` of the padded one.
fn mirrored(y: usize, margin: usize, height: usize) -> usize {
    let folded = y.abs_diff(margin);
    if folded < height { folded } else { 2 * (height - 1) - folded }
}

fn interpolate_bilinear<const N: usize>(samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; N]> {
    let mut plane = vec![[0.0; N]; samples.len()];
    let mosaic = Neighbourhood { samples, width, tile, channels: channel_rows(width, tile) };
    plane.par_chunks_mut(width).enumerate().for_each(|(y, row)| mosaic.fill(y, row));
    plane
}

/// The channels of a row's pixels, for each row of the tile.
fn channel_rows(width: usize, tile: &Tile) -> Vec<Vec<usize>> {
    (0..tile.height()).map(|y| (0..width).map(|x| tile.at(x, y)).collect()).collect()
}

/// A mosaic, and the channels of its pixels by row of the tile.
struct Neighbourhood<'a> {
    samples: &'a [f32],
    width: usize,
    tile: &'a Tile,
    channels: Vec<Vec<usize>>,
}

/// A row of the mosaic, with its weight.
struct NeighbourRow<'a> {
    samples: &'a [f32],
    channels: &'a [usize],
    weight: f32,
}

impl Neighbourhood<'_> {
    fn fill<const N: usize>(&self, y: usize, out: &mut [[f32; N]]) {
        let (reach, height) = (self.tile.reach(), self.samples.len() / self.width);
        let rows: Vec<NeighbourRow<'_>> =
            (y.saturating_sub(reach)..(y + reach + 1).min(height)).map(|row| self.row(y, row)).collect();
        for (x, colours) in out.iter_mut().enumerate() {
            *colours = interpolated(&rows, x, reach);
            colours[self.tile.at(x, y)] = self.samples[y * self.width + x];
        }
    }

    /// Row `row` as a neighbour of row `y`.
    fn row(&self, y: usize, row: usize) -> NeighbourRow<'_> {
        NeighbourRow {
            samples: &self.samples[row * self.width..][..self.width],
            channels: &self.channels[row % self.channels.len()],
            weight: (self.tile.reach() + 1 - row.abs_diff(y)) as f32,
        }
    }
}

/// Weighted means of each colour about column `x`.
fn interpolated<const N: usize>(rows: &[NeighbourRow<'_>], x: usize, reach: usize) -> [f32; N] {
    let (mut sums, mut weights) = ([0.0; N], [0.0; N]);
    for row in rows {
        for column in x.saturating_sub(reach)..(x + reach + 1).min(row.samples.len()) {
            let weight = (reach + 1 - column.abs_diff(x)) as f32 * row.weight;
            let channel = row.channels[column];
            sums[channel] += weight * row.samples[column];
            weights[channel] += weight;
        }
    }
    core::array::from_fn(|c| sums[c] / weights[c])
}

/// Reach of the filters, px.
const MALVAR_MARGIN: usize = 2;

const GREEN: usize = 1;

fn interpolate_malvar(samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; 3]> {
    let padded = PaddedRow::new(samples, width, MALVAR_MARGIN);
    let mut plane = vec![[0.0; 3]; samples.len()];
    plane.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let rows = [-2, -1, 0, 1, 2].map(|dy| padded.row(y, dy));
        for (x, rgb) in out.iter_mut().enumerate() {
            let sums = NeighbourSums::at(&rows, x + MALVAR_MARGIN);
            let own = tile.at(x, y);
            if own == GREEN {
                rgb[tile.at(x + 1, y)] = sums.row_colour_at_green();
                rgb[tile.at(x, y + 1)] = sums.column_colour_at_green();
            } else {
                rgb[GREEN] = sums.green();
                rgb[2 - own] = sums.opposite();
            }
            rgb[own] = sums.own;
        }
    });
    plane
}

/// Sums of the neighbours with equal weights.
struct NeighbourSums {
    own: f32,
    row: f32,
    column: f32,
    diagonals: f32,
    far_row: f32,
    far_column: f32,
}

impl NeighbourSums {
    fn at(rows: &[&[f32]; 5], x: usize) -> Self {
        let [above2, above, row, below, below2] = rows;
        Self {
            own: row[x],
            row: row[x - 1] + row[x + 1],
            column: above[x] + below[x],
            diagonals: (above[x - 1] + above[x + 1]) + (below[x - 1] + below[x + 1]),
            far_row: row[x - 2] + row[x + 2],
            far_column: above2[x] + below2[x],
        }
    }

    fn green(&self) -> f32 {
        (4.0 * self.own + 2.0 * (self.row + self.column) - (self.far_row + self.far_column)) / 8.0
    }

    fn row_colour_at_green(&self) -> f32 {
        (5.0 * self.own + 4.0 * self.row - self.diagonals - self.far_row + 0.5 * self.far_column) / 8.0
    }

    fn column_colour_at_green(&self) -> f32 {
        (5.0 * self.own + 4.0 * self.column - self.diagonals - self.far_column + 0.5 * self.far_row) / 8.0
    }

    fn opposite(&self) -> f32 {
        (6.0 * self.own + 2.0 * self.diagonals - 1.5 * (self.far_row + self.far_column)) / 8.0
    }
}

/// Reach of the method, px: green to 2, then the others 1 more.
const HAMILTON_ADAMS_MARGIN: usize = 3;

fn interpolate_hamilton_adams(samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; 3]> {
    let mosaic = PaddedRow::new(samples, width, HAMILTON_ADAMS_MARGIN);
    let mut green = vec![0.0; samples.len()];
    green.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let rows = [-2, -1, 0, 1, 2].map(|dy| mosaic.row(y, dy));
        for (x, g) in out.iter_mut().enumerate() {
            let at = x + HAMILTON_ADAMS_MARGIN;
            *g = if tile.at(x, y) == GREEN { rows[2][at] } else { green_at(&rows, at) };
        }
    });
    // Mirrored greens are the greens of the mirrored image: the method is symmetric.
    let padded = PaddedRow::new(&green, width, HAMILTON_ADAMS_MARGIN);
    drop(green);
    let mut plane = vec![[0.0; 3]; samples.len()];
    plane.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let around = Neighbourhood3 {
            mosaic: [-1, 0, 1].map(|dy| mosaic.row(y, dy)),
            green: [-1, 0, 1].map(|dy| padded.row(y, dy)),
        };
        for (x, rgb) in out.iter_mut().enumerate() {
            *rgb = around.colours(x + HAMILTON_ADAMS_MARGIN, tile.at(x, y), tile.at(x + 1, y));
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

/// Twice the centre less both sides.
fn second(before: f32, middle: f32, after: f32) -> f32 {
    2.0 * middle - before - after
}

/// A value along one direction, and the gradient of the image along it.
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
struct Neighbourhood3<'a> {
    mosaic: [&'a [f32]; 3],
    green: [&'a [f32]; 3],
}

impl Neighbourhood3<'_> {
    /// Steps 2 and 3, at a pixel of colour `own` whose row neighbours have the colour `beside`.
    fn colours(&self, x: usize, own: usize, neighbour: usize) -> [f32; 3] {
        let mut rgb = [0.0; 3];
        rgb[own] = self.mosaic[1][x];
        if own == GREEN {
            rgb[neighbour] = self.along([(1, x - 1), (1, x + 1)], x).value;
            rgb[2 - neighbour] = self.along([(0, x), (2, x)], x).value;
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
