//! Assignment of texels to blocks.
//!
//! Block 0 holds statistics of the whole image. Block 1 begins the finest resolution, tiles of 64 × 64 texels (fewer at the right and lower edges),
//! row by row. The coarser resolutions follow, down to one texel. Texels of bytes are stored as in their file, others, and all of coarser
//! resolutions, as three little-endian floats.

use glam::Vec3;

use super::super::texels::TexelEncoding;

/// Texels along a side of a tile.
pub(super) const TILE: u32 = 64;

/// Bytes of three floats.
pub(super) const FLOAT_TEXEL: usize = 12;

/// Bytes of the block of [`ImageStatistics`].
pub(super) const STATISTICS_BYTES: usize = 36;

/// One resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LevelLayout {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Bytes of a texel.
    pub(super) texel_bytes: usize,
    /// The block of its first tile.
    pub(super) first_block: usize,
}

impl LevelLayout {
    /// Tiles across, and tiles down.
    pub(super) fn tiles(&self) -> [u32; 2] {
        [self.width, self.height].map(|side| side.div_ceil(TILE))
    }

    /// Columns of the tiles of index `column` across.
    pub(super) fn tile_width(&self, column: u32) -> u32 {
        TILE.min(self.width - column * TILE)
    }

    /// Bytes of a tile.
    pub(super) fn tile_bytes(&self, column: u32, row: u32) -> usize {
        let rows = TILE.min(self.height - row * TILE);
        self.tile_width(column) as usize * rows as usize * self.texel_bytes
    }
}

/// All resolutions of an image, the finest first.
pub(super) fn layout(width: u32, height: u32, encoding: TexelEncoding) -> Vec<LevelLayout> {
    let texel_bytes = if encoding == TexelEncoding::Float { FLOAT_TEXEL } else { 3 };
    let mut levels = vec![LevelLayout { width, height, texel_bytes, first_block: 1 }];
    while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
        let [columns, rows] = last.tiles();
        let first_block = last.first_block + columns as usize * rows as usize;
        let (width, height) = ((last.width / 2).max(1), (last.height / 2).max(1));
        levels.push(LevelLayout { width, height, texel_bytes: FLOAT_TEXEL, first_block });
    }
    levels
}

/// Bytes of every block.
pub(super) fn lengths(levels: &[LevelLayout]) -> Vec<u32> {
    let tiles = levels.iter().flat_map(|level| {
        let [columns, rows] = level.tiles();
        (0..rows).flat_map(move |row| (0..columns).map(move |column| level.tile_bytes(column, row) as u32))
    });
    std::iter::once(STATISTICS_BYTES as u32).chain(tiles).collect()
}

/// Statistics of a whole image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct ImageStatistics {
    /// Minimum and maximum of each channel.
    pub(in super::super) ranges: [(f32, f32); 3],
    pub(in super::super) mean: Vec3,
}

impl ImageStatistics {
    pub(super) fn to_bytes(self) -> [u8; STATISTICS_BYTES] {
        let [r, g, b] = self.ranges;
        let mut bytes = [0; STATISTICS_BYTES];
        let numbers = [r.0, r.1, g.0, g.1, b.0, b.1, self.mean.x, self.mean.y, self.mean.z];
        for (four, number) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(numbers) {
            *four = number.to_le_bytes();
        }
        bytes
    }

    pub(super) fn from_bytes(bytes: &[u8; STATISTICS_BYTES]) -> Self {
        let n: [f32; 9] = core::array::from_fn(|i| f32::from_le_bytes(bytes.as_chunks().0[i]));
        Self { ranges: [(n[0], n[1]), (n[2], n[3]), (n[4], n[5])], mean: Vec3::new(n[6], n[7], n[8]) }
    }
}
