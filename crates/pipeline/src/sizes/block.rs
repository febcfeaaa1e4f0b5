//! Blocks of pixels whose paths share their tails.
//!
//! The pixels of a block carry the same wavelengths. They are therefore pixels of one colour of the sensor's filter: every `stride`-th of a square. Blocks
//! are aligned to a grid of the whole frame, independent of tiles.

use crate::sizes::tile::Tile;
use etendue_core::maths::least_common_multiple;
use etendue_core::random::Pixel;

/// Minimum side of the cells whose pixels estimate their noise together, px: fewer pixels miss light that only rare samples find.
const CELL_PX: u32 = 16;

/// Division of a frame into blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks {
    /// Columns and rows of a block; 1 for single pixels.
    side: u32,
    /// Distance between the pixels of a block, columns and rows.
    stride: (u32, u32),
}

impl Blocks {
    /// Blocks of a single pixel.
    pub const SINGLE: Self = Self { side: 1, stride: (1, 1) };

    /// Blocks of `side` × `side` pixels (a power of two), for a filter with a period of `columns` and `rows`.
    #[must_use]
    pub fn new(side: u32, columns: u32, rows: u32) -> Self {
        if side == 1 { Self::SINGLE } else { Self { side, stride: (columns, rows) } }
    }

    /// Columns and rows of pixels in a block.
    #[must_use]
    pub fn side_px(self) -> u32 {
        self.side
    }

    /// Number of pixels of a block away from the frame's border: their errors may be correlated.
    #[must_use]
    pub fn len_px(self) -> u32 {
        self.side * self.side
    }

    /// Columns and rows of the smallest area that contains whole blocks of every colour.
    fn cell(self) -> (u32, u32) {
        (self.side * self.stride.0, self.side * self.stride.1)
    }

    /// Smallest side of a tile, at least `requested_px`, that does not split a block.
    #[must_use]
    pub fn tile_px(self, requested_px: u32) -> u32 {
        let (columns, rows) = self.cell();
        requested_px.next_multiple_of(least_common_multiple(columns, rows))
    }

    /// Side of the cells whose pixels estimate their noise together, px: they do not split a block. Cells are aligned to a grid of the whole frame.
    #[must_use]
    pub fn cell_px(self) -> u32 {
        self.tile_px(CELL_PX)
    }

    /// Blocks of a tile that splits none, each with its pixels; consecutive pixels are far apart in the block.
    pub fn in_tile(self, tile: Tile) -> impl Iterator<Item = Vec<Pixel>> {
        let (columns, rows) = self.cell();
        let corners =
            starts(tile.y0, tile.y1, rows).flat_map(move |y| starts(tile.x0, tile.x1, columns).map(move |x| (x, y)));
        corners
            .flat_map(move |corner| self.phases().map(move |(i, j)| (corner.0 + i, corner.1 + j)))
            .map(move |(x, y)| self.pixels(x, y).filter(|p| p.x < tile.x1 && p.y < tile.y1).collect::<Vec<_>>())
            .filter(|block| !block.is_empty())
    }

    fn phases(self) -> impl Iterator<Item = (u32, u32)> {
        let (columns, rows) = self.stride;
        (0..rows).flat_map(move |j| (0..columns).map(move |i| (i, j)))
    }

    /// Pixels of the block that starts at (`x`, `y`).
    fn pixels(self, x: u32, y: u32) -> impl Iterator<Item = Pixel> {
        (0..self.side * self.side).map(move |rank| {
            let (i, j) = spread(rank, self.side);
            Pixel { x: x + i * self.stride.0, y: y + j * self.stride.1 }
        })
    }
}

fn starts(from: u32, to: u32, step: u32) -> impl Iterator<Item = u32> + Clone {
    (from..to).step_by(step as usize)
}

/// The `rank`-th position in a square of `side` (a power of two) in the order of an ordered dither (Bayer 1973): every quarter of the ranks is spread over
/// the whole square.
fn spread(rank: u32, side: u32) -> (u32, u32) {
    let (mut x, mut y, mut half, mut rest) = (0, 0, side / 2, rank);
    while half > 0 {
        let (right, other) = (rest & 1, rest >> 1 & 1);
        x += (right ^ other) * half;
        y += right * half;
        (half, rest) = (half / 2, rest >> 2);
    }
    (x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sizes::tile::{Shard, tiles};

    /// Blocks of a frame of 37 × 23 pixels, divided into tiles of at least `tile_px`.
    fn blocks(blocks: Blocks, tile_px: u32) -> Vec<Vec<(u32, u32)>> {
        let block_tiles = tiles(37, 23, blocks.tile_px(tile_px), Shard::WHOLE);
        let all = block_tiles.into_iter().flat_map(|tile| blocks.in_tile(tile));
        let mut all: Vec<Vec<_>> = all.map(|block| block.into_iter().map(|p| (p.x, p.y)).collect()).collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn blocks_hold_every_pixel_once_whatever_the_tiles() {
        for layout in [Blocks::SINGLE, Blocks::new(4, 1, 1), Blocks::new(2, 2, 2), Blocks::new(4, 2, 4)] {
            let mut pixels: Vec<_> = blocks(layout, 8).into_iter().flatten().collect();
            pixels.sort_unstable();
            pixels.dedup();
            assert_eq!(pixels.len(), 37 * 23, "{layout:?}");
            assert_eq!(blocks(layout, 8), blocks(layout, 32), "{layout:?}");
        }
    }

    #[test]
    fn pixels_of_a_block_have_one_colour() {
        for block in blocks(Blocks::new(4, 2, 3), 16) {
            let colour = |p: &(u32, u32)| (p.0 % 2, p.1 % 3);
            assert!(block.iter().all(|p| colour(p) == colour(&block[0])));
        }
    }

    #[test]
    fn a_quarter_of_a_block_is_spread_over_it() {
        let places: Vec<_> = (0..16).map(|rank| spread(rank, 4)).collect();
        for quarter in places.chunks(4) {
            let mut squares: Vec<_> = quarter.iter().map(|(x, y)| (x / 2, y / 2)).collect();
            squares.sort_unstable();
            assert_eq!(squares, [(0, 0), (0, 1), (1, 0), (1, 1)]);
        }
    }
}
