//! Weighted means of neighbours.
//!
//! A pixel keeps the colour it measured. Each other colour is the mean of the neighbours within the tile's reach r (one
//! for tiles of two by two) that measured it, weighted (r + 1 − |Δx|)(r + 1 − |Δy|): 2 beside and above, 1 across the corner
//! for r = 1. On a Bayer tile this is bilinear interpolation, and a linear ramp comes out exact inside. At the picture's
//! edge the mean is over the neighbours that exist.

use crate::mosaic::Tile;
use rayon::prelude::*;

pub(super) fn demosaic<const N: usize>(samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; N]> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{self, Blue, Clear, Green, Infrared, Red};
    use crate::mosaic::Mosaic;

    fn tile(width: usize, filters: &[Filter]) -> Tile {
        match Mosaic::tile(width, filters.len() / width, filters.to_vec()) {
            Ok(Mosaic::Tile(tile)) => tile,
            _ => unreachable!("a legal tile"),
        }
    }

    #[test]
    fn corners_and_edges_use_the_neighbours_that_exist() {
        // R G R G
        // G B G B
        // R G R G
        let samples: Vec<f32> =
            [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]].as_flattened().iter().map(|v| *v as f32).collect();
        let plane: Vec<[f32; 3]> = demosaic(&samples, 4, &tile(2, &[Red, Green, Green, Blue]));
        assert_eq!(plane[0], [1.0, (2.0 + 5.0) / 2.0, 6.0]);
        assert_eq!(plane[1], [(1.0 + 3.0) / 2.0, 2.0, 6.0]);
        assert_eq!(plane[2], [3.0, (2.0 + 4.0 + 7.0) / 3.0, (6.0 + 8.0) / 2.0]);
        assert_eq!(plane[7], [(3.0 + 11.0) / 2.0, (4.0 + 7.0 + 12.0) / 3.0, 8.0]);
        assert_eq!(plane[11], [11.0, 12.0, 8.0]);
    }

    #[test]
    fn two_and_four_channels_work_alike() {
        let rccc = tile(2, &[Red, Clear, Clear, Clear]);
        let ramp: Vec<f32> = (0..63).map(|i| (i % 9 * 8 + i / 9 * 4) as f32).collect();
        let plane: Vec<[f32; 2]> = demosaic(&ramp, 9, &rccc);
        for (x, y) in (1..6).flat_map(|y| (1..8).map(move |x| (x, y))) {
            assert_eq!(plane[y * 9 + x], [(x * 8 + y * 4) as f32; 2]);
        }
        let rgbi = tile(2, &[Red, Green, Infrared, Blue]);
        let colours = [0.1, 0.2, 0.3, 0.4];
        let flat: Vec<f32> = (0..64).map(|i| colours[rgbi.at(i % 8, i / 8)]).collect();
        let plane: Vec<[f32; 4]> = demosaic(&flat, 8, &rgbi);
        // A mean of equal numbers rounds at most a few times.
        assert!(plane.iter().all(|v| (0..4).all(|c| (v[c] - colours[c]).abs() < 1e-7)));
    }

    #[test]
    fn a_quad_bayer_tile_reaches_two_pixels_far() {
        let quad = [Red, Red, Green, Green, Red, Red, Green, Green, Green, Green, Blue, Blue, Green, Green, Blue, Blue];
        let quad = tile(4, &quad);
        let colours = [0.5, 0.25, 0.75];
        let flat: Vec<f32> = (0..99).map(|i| colours[quad.at(i % 11, i / 11)]).collect();
        assert!(demosaic::<3>(&flat, 11, &quad).iter().all(|rgb| *rgb == colours));
    }
}
