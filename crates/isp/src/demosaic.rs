//! Bilinear demosaic.
//!
//! A pixel keeps the colour it measured. Each other colour is the mean of the neighbours (three by three) that measured
//! it, weighted 2 beside and above, 1 across the corner: on a Bayer tile this is bilinear interpolation. At the
//! picture's edge the mean is over the neighbours that exist. A linear ramp comes out exact inside.

use crate::mosaic::{Filter, Mosaic, Tile};
use etendue_core::Plane;
use etendue_core::quantity::LinearRgb;
use rayon::prelude::*;

/// Colours of a mosaic of `width` columns; `mosaic_samples` row by row, at least two by two where the mosaic is a tile.
/// Runs in the rayon pool of the caller; the result does not depend on it.
#[must_use]
pub(crate) fn demosaic(mosaic_samples: &[f32], width: usize, mosaic: &Mosaic) -> Plane<LinearRgb> {
    let mut plane = Plane::new(width, mosaic_samples.len() / width.max(1));
    let rows = plane.samples_mut().par_chunks_mut(width.max(1)).enumerate();
    match mosaic {
        Mosaic::Mono => rows.for_each(|(y, row)| {
            for (rgb, v) in row.iter_mut().zip(&mosaic_samples[y * width..]) {
                *rgb = [*v; 3];
            }
        }),
        Mosaic::Tile(tile) => rows.for_each(|(y, row)| demosaic_row(mosaic_samples, width, tile, y, row)),
    }
    plane
}

fn demosaic_row(samples: &[f32], width: usize, tile: &Tile, y: usize, row: &mut [[f32; 3]]) {
    let height = samples.len() / width;
    let neighbours: Vec<NeighbourRow<'_>> = (y.saturating_sub(1)..(y + 2).min(height))
        .map(|row| NeighbourRow {
            samples: &samples[row * width..][..width],
            filters: (0..width).map(|x| tile.at(x, row)).collect(),
            weight: if row == y { 2.0 } else { 1.0 },
        })
        .collect();
    for (x, rgb) in row.iter_mut().enumerate() {
        *rgb = interpolated(&neighbours, x);
        rgb[tile.at(x, y) as usize] = samples[y * width + x];
    }
}

/// A row of the mosaic, with its weight.
struct NeighbourRow<'a> {
    samples: &'a [f32],
    filters: Vec<Filter>,
    weight: f32,
}

/// Weighted means of each colour about column `x`.
fn interpolated(rows: &[NeighbourRow<'_>], x: usize) -> [f32; 3] {
    let (mut sums, mut weights) = ([0.0; 3], [0.0; 3]);
    for row in rows {
        for column in x.saturating_sub(1)..(x + 2).min(row.samples.len()) {
            let weight = if column == x { 2.0 * row.weight } else { row.weight };
            let colour = row.filters[column] as usize;
            sums[colour] += weight * row.samples[column];
            weights[colour] += weight;
        }
    }
    core::array::from_fn(|c| sums[c] / weights[c])
}

#[cfg(test)]
mod tests {
    use super::Filter::{Blue, Green, Red};
    use super::*;

    fn phases() -> [Mosaic; 4] {
        [[Red, Green, Green, Blue], [Green, Red, Blue, Green], [Green, Blue, Red, Green], [Blue, Green, Green, Red]]
            .map(|f| Mosaic::tile(2, 2, f.to_vec()).expect("Bayer"))
    }

    #[test]
    fn a_ramp_is_exact_inside_and_a_grey_everywhere() {
        let (width, height) = (9, 7);
        let ramp: Vec<f32> = (0..width * height).map(|i| ((i % width) * 8 + (i / width) * 4) as f32).collect();
        for mosaic in phases() {
            let plane = demosaic(&ramp, width, &mosaic);
            for (x, y) in (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y))) {
                // Sums of small whole numbers over powers of two: no rounding at all.
                assert_eq!(plane.at(x, y), [(x * 8 + y * 4) as f32; 3]);
            }
            let grey = demosaic(&[0.25; 12], 4, &mosaic);
            assert!(grey.samples().iter().all(|rgb| *rgb == [0.25; 3]));
        }
    }

    #[test]
    fn corners_and_edges_use_the_neighbours_that_exist() {
        // R G R G
        // G B G B
        // R G R G
        let samples: Vec<f32> =
            [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]].as_flattened().iter().map(|v| *v as f32).collect();
        let plane = demosaic(&samples, 4, &phases()[0]);
        assert_eq!(plane.at(0, 0), [1.0, (2.0 + 5.0) / 2.0, 6.0]);
        assert_eq!(plane.at(1, 0), [(1.0 + 3.0) / 2.0, 2.0, 6.0]);
        assert_eq!(plane.at(2, 0), [3.0, (2.0 + 4.0 + 7.0) / 3.0, (6.0 + 8.0) / 2.0]);
        assert_eq!(plane.at(3, 1), [(3.0 + 11.0) / 2.0, (4.0 + 7.0 + 12.0) / 3.0, 8.0]);
        assert_eq!(plane.at(3, 2), [11.0, 12.0, 8.0]);
    }

    #[test]
    fn mono_passes_through() {
        let plane = demosaic(&[1.0, 2.0, 3.0], 3, &Mosaic::Mono);
        assert_eq!(plane.samples(), [[1.0; 3], [2.0; 3], [3.0; 3]]);
        assert_eq!(demosaic(&[], 0, &Mosaic::Mono).samples().len(), 0);
    }
}
