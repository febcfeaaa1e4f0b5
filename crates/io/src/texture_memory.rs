//! Memory limits of images: the choice between textures in memory and textures read tile by tile, and the maximum decompressed size of an image.
//!
//! A small file must not fill the memory. An image may decompress to at most 8 times the size of its file, or to the limit `picture-mib` if that is more
//! (docs/limits.md). Images of floats and those that are measured count 4 bytes per sample, others as their file stores them. The size is known from the
//! header, before decompression.

use std::path::{Path, PathBuf};

use etendue_scene::{asset::PixelFormat, limits::PICTURE};

use crate::{Error, ErrorCode, tile_cache::CacheUse};

/// Memory limit of textures, and storage of those that exceed it. No result depends on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureMemory {
    /// Maximum bytes of texels in memory, over all resolutions.
    pub limit_bytes: u64,
    /// Folder of the tiles; `None`: the user's ([`TileCache::new`](crate::tile_cache::TileCache::new)).
    pub cache: Option<PathBuf>,
    /// Use of that folder.
    pub cache_use: CacheUse,
}

impl Default for TextureMemory {
    /// 512 MB.
    fn default() -> Self {
        Self { limit_bytes: 512_000_000, cache: None, cache_use: CacheUse::Keep }
    }
}

impl TextureMemory {
    /// Selects the large images by their bytes: none if all fit; else all except the smallest, which may take half of the limit and leave the other half to
    /// tiles.
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

/// Bytes of the texels of an image at all resolutions: those of its file, plus a third as many texels of three floats.
pub(crate) fn pyramid_bytes(width: u32, height: u32, format: PixelFormat) -> u64 {
    let texel = if format.is_bytes() { 3 } else { 12 };
    u64::from(width) * u64::from(height) * (texel + 4)
}

/// Maximum ratio of decompressed to compressed size for any file.
const TIMES_PACKED: u128 = 8;

/// Refuses samples of 32 bits that are too many for a file of `packed` bytes.
pub(crate) fn check(file: &Path, samples: u128, packed: usize) -> Result<(), Error> {
    check_bytes(file, in_bytes(samples), packed)
}

/// Refuses bytes that are too many for a file of `packed` bytes.
pub(crate) fn check_bytes(file: &Path, bytes: u128, packed: usize) -> Result<(), Error> {
    let limit = max_bytes(packed);
    if bytes <= limit {
        return Ok(());
    }
    let message = format!(
        "decompresses to {} MiB; at most {} MiB are allowed for a file of its size: make the image smaller, {}",
        mebibytes(bytes),
        mebibytes(limit),
        PICTURE.remedy_bytes(bytes)
    );
    Err(Error::coded(ErrorCode::TooLarge, file, message))
}

/// Maximum decompressed bytes of a file of `packed` bytes.
pub(crate) fn max_bytes(packed: usize) -> u128 {
    u128::from(PICTURE.max_bytes()).max(TIMES_PACKED * packed as u128)
}

/// Refuses 32-bit samples of more than `most` bytes, if their expected number is known.
pub(crate) fn check_within(file: &Path, samples: u128, limit: u128) -> Result<(), Error> {
    let bytes = in_bytes(samples);
    if bytes <= limit {
        return Ok(());
    }
    let (actual, expected) = (mebibytes(bytes), mebibytes(limit));
    Err(Error::coded(
        ErrorCode::TooLarge,
        file,
        format!("decompresses to {actual} MiB; expected {expected} MiB: render it again"),
    ))
}

fn in_bytes(samples: u128) -> u128 {
    samples.saturating_mul(size_of::<f32>() as u128)
}

fn mebibytes(bytes: u128) -> u128 {
    bytes.div_ceil(1 << 20)
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

    #[test]
    fn a_measurement_may_unpack_and_a_bomb_may_not() {
        let file = Path::new("a.exr");
        // Two megapixels of 38 bands with their variance, however well they compress.
        assert!(check(file, 2_000_000 * 76, 500).is_ok());
        // A header of 20 000² pixels; 100 MB that decompress to 100 GB.
        let message = check(file, 400_000_000, 500).expect_err("a bomb").to_string();
        let expected = "a.exr: decompresses to 1526 MiB; at most 1024 MiB are allowed for a file of its size: make the image smaller, or raise the limit: `limit` picture-mib=1526";
        assert_eq!(message, expected);
        assert!(check(file, 25_000_000_000, 100_000_000).is_err());
        // A measurement of 40 GB in a file of 5 GB.
        assert!(check(file, 10_000_000_000, 5_000_000_000).is_ok());
    }
}
