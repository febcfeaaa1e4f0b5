//! Gradient-corrected linear interpolation (Malvar, He & Cutler 2004, "High-quality linear interpolation for demosaicing of
//! Bayer-patterned color images", ICASSP).
//!
//! The bilinear value of the missing colour plus α, β or γ times the second difference of the colour that the pixel did
//! measure: where its own colour peaks, so will the others. With the paper's α = 1/2, β = 5/8, γ = 3/4 (the optimum over
//! its pictures, rounded to eighths) these are four filters of five by five, in eighths:
//!
//! | wanted | at | its own | same row ±1 | same column ±1 | diagonals | same row ±2 | same column ±2 |
//! | --- | --- | --- | --- | --- | --- | --- | --- |
//! | green | red, blue | 4 | 2 | 2 | 0 | −1 | −1 |
//! | the row's other colour | green | 5 | 4 | 0 | −1 | −1 | ½ |
//! | the column's other colour | green | 5 | 0 | 4 | −1 | ½ | −1 |
//! | blue, red | red, blue | 6 | 0 | 0 | 2 | −3/2 | −3/2 |
//!
//! The picture is mirrored about its outermost pixels. Beside edges values can leave the range of the neighbours.

use super::padded::Padded;
use crate::mosaic::Tile;
use rayon::prelude::*;

/// How far the filters reach, px.
pub(super) const MARGIN: usize = 2;

const GREEN: usize = 1;

pub(super) fn demosaic(samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; 3]> {
    let padded = Padded::new(samples, width, MARGIN);
    let mut plane = vec![[0.0; 3]; samples.len()];
    plane.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let rows = [-2, -1, 0, 1, 2].map(|dy| padded.row(y, dy));
        for (x, rgb) in out.iter_mut().enumerate() {
            let sums = Sums::at(&rows, x + MARGIN);
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

/// Sums of the neighbours that the filters weigh alike.
struct Sums {
    own: f32,
    row: f32,
    column: f32,
    diagonals: f32,
    far_row: f32,
    far_column: f32,
}

impl Sums {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{Blue, Green, Red};
    use crate::mosaic::Mosaic;

    #[test]
    fn an_impulse_shows_the_filters_of_the_paper() {
        let Ok(Mosaic::Tile(tile)) = Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]) else { unreachable!("Bayer") };
        let impulse = |at: [usize; 2]| {
            let mut samples = vec![0.0; 81];
            samples[at[1] * 9 + at[0]] = 8.0;
            demosaic(&samples, 9, &tile)
        };
        // A red pixel at (4, 4): green and blue there, what it adds to others.
        let red = impulse([4, 4]);
        let at = |plane: &[[f32; 3]], x: usize, y: usize| plane[y * 9 + x];
        assert_eq!(at(&red, 4, 4), [8.0, 4.0, 6.0]);
        assert_eq!(at(&red, 6, 4), [0.0, -1.0, -1.5]);
        assert_eq!(at(&red, 5, 4), [4.0, 0.0, 0.0]);
        assert_eq!(at(&red, 5, 5), [2.0, 0.0, 0.0]);
        // A green pixel in a red row, at (5, 4).
        let green = impulse([5, 4]);
        assert_eq!(at(&green, 5, 4), [5.0, 8.0, 5.0]);
        assert_eq!(at(&green, 7, 4), [-1.0, 0.0, 0.5]);
        assert_eq!(at(&green, 5, 6), [0.5, 0.0, -1.0]);
        assert_eq!(at(&green, 4, 5), [-1.0, 0.0, -1.0]);
        assert_eq!(at(&green, 4, 4), [0.0, 2.0, 0.0]);
    }
}
