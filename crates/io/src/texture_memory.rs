//! Which pictures of textures are held in memory, and which are read tile by tile.

use std::path::PathBuf;

use etendue_scene::asset::PixelFormat;

use crate::tile_cache::CacheUse;

/// How much memory textures may take, and where those are kept that take more. No result depends on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureMemory {
    /// Most bytes of texels in memory, at all resolutions together.
    pub limit_bytes: u64,
    /// The folder of the tiles; `None`: the user's ([`TileCache::new`](crate::tile_cache::TileCache::new)).
    pub cache: Option<PathBuf>,
    /// What is done with that folder.
    pub cache_use: CacheUse,
}

impl Default for TextureMemory {
    /// 512 MB.
    fn default() -> Self {
        Self { limit_bytes: 512_000_000, cache: None, cache_use: CacheUse::Keep }
    }
}

impl TextureMemory {
    /// Of pictures of these bytes, which are large: none where all fit; else all but the smallest, which may take half of the limit and leave
    /// the other to tiles.
    pub(crate) fn large(&self, bytes: &[u64]) -> Vec<bool> {
        if bytes.iter().sum::<u64>() <= self.limit_bytes {
            return vec![false; bytes.len()];
        }
        let mut by_size: Vec<usize> = (0..bytes.len()).collect();
        by_size.sort_by_key(|i| bytes[*i]);
        let (mut large, mut held) = (vec![false; bytes.len()], 0);
        for i in by_size {
            held += bytes[i];
            large[i] = held > self.limit_bytes / 2;
        }
        large
    }
}

/// Bytes of the texels of a picture at all resolutions: what its file has, and a third as many texels of three floats.
pub(crate) fn pyramid_bytes(width: u32, height: u32, format: PixelFormat) -> u64 {
    let texel = if format.is_bytes() { 3 } else { 12 };
    u64::from(width) * u64::from(height) * (texel + 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_stay_where_not_all_fit() {
        let large = |limit_bytes, bytes: &[u64]| TextureMemory { limit_bytes, ..TextureMemory::default() }.large(bytes);
        assert_eq!(large(100, &[40, 60]), [false, false]);
        assert_eq!(large(100, &[40, 61]), [false, true]);
        assert_eq!(large(100, &[29, 100, 10, 11]), [false, true, false, false]);
        assert_eq!(large(100, &[30, 100, 10, 11]), [true, true, false, false], "51 of 50");
        assert_eq!(large(1, &[30, 100]), [true, true]);
        assert_eq!(large(1, &[]), [false; 0]);
        assert_eq!(pyramid_bytes(8192, 8192, PixelFormat::Rgb8), 7 << 26);
    }
}
