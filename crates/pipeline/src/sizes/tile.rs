//! Tiles of a frame, and the shard of them that one run renders.

use etendue_core::random::Pixel;

/// A rectangle of pixels: columns `x0..x1`, rows `y0..y1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One past the last column.
    pub x1: u32,
    /// One past the last row.
    pub y1: u32,
}

impl Tile {
    /// The pixels of the tile, row by row.
    pub fn pixels(self) -> impl Iterator<Item = Pixel> {
        (self.y0..self.y1).flat_map(move |y| (self.x0..self.x1).map(move |x| Pixel { x, y }))
    }

    /// Squares of `side` pixels in the tile, row by row; smaller at its right and lower edges.
    pub fn parts(self, side: u32) -> impl Iterator<Item = Tile> {
        let starts = move |from: u32, to: u32| (from..to).step_by(side as usize);
        starts(self.y0, self.y1).flat_map(move |y0| {
            starts(self.x0, self.x1).map(move |x0| Tile {
                x0,
                y0,
                x1: (x0 + side).min(self.x1),
                y1: (y0 + side).min(self.y1),
            })
        })
    }

    /// Number of pixels.
    #[must_use]
    pub fn len(self) -> usize {
        (self.x1 - self.x0) as usize * (self.y1 - self.y0) as usize
    }

    /// Returns true if the tile has no pixel (never for tiles from [`tiles`]).
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }
}

/// Part of a frame's tiles that one run renders: those whose number is `index` modulo `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u32,
    count: u32,
}

impl Shard {
    /// Every tile.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Shard `index` of `count`. `None` unless `index < count`.
    #[must_use]
    pub fn new(index: u32, count: u32) -> Option<Self> {
        (index < count).then_some(Self { index, count })
    }

    /// Index of the shard.
    #[must_use]
    pub fn index(self) -> u32 {
        self.index
    }

    /// Number of shards.
    #[must_use]
    pub fn count(self) -> u32 {
        self.count
    }

    fn owns(self, tile: usize) -> bool {
        tile as u64 % u64::from(self.count) == u64::from(self.index)
    }
}

/// Tiles of a frame of `width` × `height` pixels in `shard`, in order. Tiles are `side` pixels square except at the right and lower edges.
#[must_use]
pub fn tiles(width: u32, height: u32, side: u32, shard: Shard) -> Vec<Tile> {
    let starts = |length: u32| (0..length).step_by(side.max(1) as usize);
    starts(height)
        .flat_map(|y0| starts(width).map(move |x0| (x0, y0)))
        .enumerate()
        .filter(|(number, _)| shard.owns(*number))
        .map(|(_, (x0, y0))| Tile { x0, y0, x1: (x0 + side).min(width), y1: (y0 + side).min(height) })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_every_pixel_once() {
        let mut counts = vec![0; 37 * 23];
        for index in 0..3 {
            for tile in tiles(37, 23, 8, Shard::new(index, 3).expect("a shard")) {
                tile.pixels().for_each(|p| counts[(p.y * 37 + p.x) as usize] += 1);
            }
        }
        assert!(counts.iter().all(|n| *n == 1));
        assert!(Shard::new(3, 3).is_none());
    }
}
