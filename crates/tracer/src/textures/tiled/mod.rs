//! Images whose texels are stored outside memory, tile by tile, and read at look-up.
//!
//! The values are bit for bit those of the same image in memory: the same texels at all resolutions, interpolated by the same operations. The number
//! of tiles in memory, and the threads that read them, change only the time of a look-up.

mod layout;
mod memory;
mod writer;
use std::sync::Arc;

use etendue_core::storage::Blocks;
use glam::Vec3;

use super::mipmap::{TexelLevel, neighbours};
use super::projection::Wrap;
use super::texels::{Texel as _, TexelEncoding};
use layout::{FLOAT_TEXEL, ImageStatistics, LevelLayout, STATISTICS_BYTES, TILE, layout};
use memory::Tiles;

pub use memory::TileMemory;
pub use writer::PyramidWriter;

/// One resolution of an image.
#[derive(Clone, Debug)]
pub(super) struct TiledLevel {
    layout: LevelLayout,
    tiles: Arc<Tiles>,
    /// The linear values of bytes, for texels that are bytes.
    linear: Option<Arc<[f32; 256]>>,
}

/// The resolutions of an image of columns and rows, and the statistics of the whole.
///
/// # Errors
/// If the blocks cannot be read.
pub(super) fn levels(
    width: u32,
    height: u32,
    encoding: TexelEncoding,
    blocks: Arc<dyn Blocks>,
    memory: &Arc<TileMemory>,
) -> Result<(Vec<TiledLevel>, ImageStatistics), String> {
    let mut statistics = [0; STATISTICS_BYTES];
    blocks.read(0, &mut statistics)?;
    let tiles = Arc::new(Tiles::new(blocks, Arc::clone(memory)));
    let linear: Option<Arc<[f32; 256]>> = encoding.table().map(Arc::from);
    let level = |layout: LevelLayout| TiledLevel {
        layout,
        tiles: Arc::clone(&tiles),
        linear: linear.clone().filter(|_| layout.texel_bytes < FLOAT_TEXEL),
    };
    Ok((layout(width, height, encoding).into_iter().map(level).collect(), ImageStatistics::from_bytes(&statistics)))
}

impl TiledLevel {
    /// Columns and rows.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.layout.width, self.layout.height)
    }

    /// Bytes of its texels outside memory.
    pub(super) fn bytes(&self) -> u64 {
        u64::from(self.layout.width) * u64::from(self.layout.height) * self.layout.texel_bytes as u64
    }

    /// The memory of its tiles.
    pub(super) fn memory(&self) -> &Arc<TileMemory> {
        self.tiles.memory()
    }

    /// Applies `value` to the tile that contains a texel.
    fn with_tile<T>(&self, [x, y]: [usize; 2], value: impl FnOnce(&[u8]) -> T) -> T {
        let tile = [x as u32 / TILE, y as u32 / TILE];
        let block = self.layout.first_block + tile[1] as usize * self.layout.tiles()[0] as usize + tile[0] as usize;
        self.tiles.with(block, self.layout.tile_bytes(tile[0], tile[1]), value)
    }

    /// A texel of the tile that contains it; 0 if the tile could not be read.
    fn texel_in(&self, tile: &[u8], [x, y]: [usize; 2]) -> Vec3 {
        let width = self.layout.tile_width(x as u32 / TILE) as usize;
        let at = (y % TILE as usize * width + x % TILE as usize) * self.layout.texel_bytes;
        let bytes = tile.get(at..).unwrap_or_default();
        match &self.linear {
            Some(linear) => bytes.first_chunk().map_or(Vec3::ZERO, |bytes| Vec3::decoded(*bytes, linear)),
            None => bytes.first_chunk().map_or(Vec3::ZERO, float_texel),
        }
    }

    fn texel(&self, at: [usize; 2]) -> Vec3 {
        self.with_tile(at, |tile| self.texel_in(tile, at))
    }
}

impl TexelLevel<Vec3> for TiledLevel {
    fn bilinear(&self, s: f32, t: f32, wrap: [Wrap; 2]) -> Vec3 {
        let (x0, x1, fx) = neighbours(s, self.layout.width, wrap[0]);
        let (y0, y1, fy) = neighbours(t, self.layout.height, wrap[1]);
        let places = [[x0, y0], [x1, y0], [x0, y1], [x1, y1]];
        let tile = |i: usize| i / TILE as usize;
        let four = if tile(x0) == tile(x1) && tile(y0) == tile(y1) {
            self.with_tile(places[0], |tile| places.map(|at| self.texel_in(tile, at)))
        } else {
            places.map(|at| self.texel(at))
        };
        let top = four[0].towards(four[1], fx);
        let bottom = four[2].towards(four[3], fx);
        top.towards(bottom, fy)
    }
}

fn float_texel(bytes: &[u8; FLOAT_TEXEL]) -> Vec3 {
    let [x, y, z] = [0, 1, 2].map(|i| f32::from_le_bytes(bytes.as_chunks().0[i]));
    Vec3::new(x, y, z)
}
