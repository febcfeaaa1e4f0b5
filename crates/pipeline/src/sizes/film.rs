//! The planes of a film, and the bytes that they take in memory and in scratch files.

use super::tile::Shard;
use etendue_core::Bands;
use etendue_core::storage::NUMBER_BYTES;

/// The planes that every pixel's samples are gathered into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Spectral bands, where a cube is kept.
    pub bands: Option<Bands>,
    /// Whether each pixel folds its own responsivity into electrons.
    pub folded: bool,
    /// Whether a limit of noise watches the pixel's light: its electrons where they are folded, else its irradiance over all wavelengths.
    pub watched: bool,
}

impl Layout {
    /// Numbers a pixel: the bands, the pupil's weight, the electrons or the irradiance that is watched in their place.
    pub(crate) fn slots(&self) -> usize {
        self.band_count() + 1 + usize::from(self.folded || self.watched)
    }

    /// The place of what is watched.
    pub(crate) fn watched_slot(&self) -> usize {
        self.band_count() + 1
    }

    pub(crate) fn band_count(&self) -> usize {
        self.bands.map_or(0, Bands::count)
    }

    /// Bytes that a film of this size and layout takes in memory; a float, for a picture too large to be made must not overflow.
    #[must_use]
    pub fn bytes(&self, width: usize, height: usize) -> f64 {
        self.cube_bytes(width, height) + self.bytes_beside_cube(width, height)
    }

    /// Bytes of the bands of a film, in memory.
    #[must_use]
    pub fn cube_bytes(&self, width: usize, height: usize) -> f64 {
        plane_bytes(width, height) * (2 * self.bands.map_or(0, Bands::count)) as f64
    }

    /// Bytes of all else, which always is in memory.
    #[must_use]
    pub fn bytes_beside_cube(&self, width: usize, height: usize) -> f64 {
        let planes = 2 * (usize::from(self.folded) + usize::from(self.watched)) + 3;
        plane_bytes(width, height) * planes as f64
    }
}

/// Bytes of a plane of 32-bit numbers.
fn plane_bytes(width: usize, height: usize) -> f64 {
    width as f64 * height as f64 * size_of::<f32>() as f64
}

/// Whether the bands of a film have variances that say something: those of one replicate are unknown, and all are kept of a shard, whose other
/// tiles are 0.
pub(crate) fn has_variance(replicates: u32, shard: Shard) -> bool {
    replicates > 1 || shard != Shard::WHOLE
}

/// Planes of bands in a scratch file: means, and variances where there are some.
pub(crate) fn scratch_planes(bands: Bands, has_variance: bool) -> usize {
    bands.count() * if has_variance { 2 } else { 1 }
}

/// Bytes in a scratch file of the bands of that many pixels.
#[must_use]
pub(crate) fn scratch_bytes(pixels: f64, bands: Bands, has_variance: bool) -> f64 {
    pixels * (scratch_planes(bands, has_variance) * NUMBER_BYTES) as f64
}
