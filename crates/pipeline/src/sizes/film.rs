//! Planes of a film, and their bytes in memory and in scratch files.

use super::tile::Shard;
use etendue_core::Bands;
use etendue_core::storage::NUMBER_BYTES;

/// Planes that accumulate each pixel's samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmLayout {
    /// Spectral bands, if a cube is stored.
    pub bands: Option<Bands>,
    /// True if each pixel weights radiance by its responsivity and accumulates electrons.
    pub accumulates_electrons: bool,
    /// True if a noise limit monitors the pixel's light: its electrons if these are accumulated, otherwise its irradiance over all wavelengths.
    pub watched: bool,
}

impl FilmLayout {
    /// Number of values per pixel: the bands, the pupil's weight, the electrons or, instead of them, the monitored irradiance.
    pub(crate) fn slots(&self) -> usize {
        self.band_count() + 1 + usize::from(self.accumulates_electrons || self.watched)
    }

    /// Index of the monitored value.
    pub(crate) fn watched_slot(&self) -> usize {
        self.band_count() + 1
    }

    pub(crate) fn band_count(&self) -> usize {
        self.bands.map_or(0, Bands::count)
    }

    /// Bytes of a film of this size and layout in memory; a float, because an impossibly large image must not overflow.
    #[must_use]
    pub fn bytes(&self, width: usize, height: usize) -> f64 {
        self.cube_bytes(width, height) + self.bytes_without_cube(width, height)
    }

    /// Bytes of the bands of a film in memory.
    #[must_use]
    pub fn cube_bytes(&self, width: usize, height: usize) -> f64 {
        plane_bytes(width, height) * (2 * self.bands.map_or(0, Bands::count)) as f64
    }

    /// Bytes of everything else, which is always in memory.
    #[must_use]
    pub fn bytes_without_cube(&self, width: usize, height: usize) -> f64 {
        let planes = 2 * (usize::from(self.accumulates_electrons) + usize::from(self.watched)) + 3;
        plane_bytes(width, height) * planes as f64
    }
}

/// Bytes of a plane of 32-bit numbers.
fn plane_bytes(width: usize, height: usize) -> f64 {
    width as f64 * height as f64 * size_of::<f32>() as f64
}

/// Returns true if the bands of a film have useful variances: those of one replicate are unknown, and a shard stores all, with 0 in other tiles.
pub(crate) fn has_variance(replicates: u32, shard: Shard) -> bool {
    replicates > 1 || shard != Shard::WHOLE
}

/// Planes of bands in a scratch file: means, and variances if there are any.
pub(crate) fn scratch_planes(bands: Bands, has_variance: bool) -> usize {
    bands.count() * if has_variance { 2 } else { 1 }
}

/// Bytes of the bands of `pixels` pixels in a scratch file.
#[must_use]
pub(crate) fn scratch_bytes(pixels: f64, bands: Bands, has_variance: bool) -> f64 {
    pixels * (scratch_planes(bands, has_variance) * NUMBER_BYTES) as f64
}
