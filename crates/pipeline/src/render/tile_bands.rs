//! Bands of a tile of a film: the unit of writing to a scratch file.

use crate::render::gather::{PixelLight, stored_variance};
use crate::sizes::tile::Tile;
use etendue_core::quantity::{Irradiance, Variance};
use etendue_core::random::Pixel;
use etendue_core::{Plane, SpectralCube};

/// Means and variances of the bands of a tile's pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct TileBands {
    tile: Tile,
    count: usize,
    /// Bands in order, each row by row: all means, then all variances.
    samples: Vec<f32>,
}

impl TileBands {
    /// A tile of `count` bands, all 0.
    pub(super) fn new(tile: Tile, count: usize) -> Self {
        Self { tile, count, samples: vec![0.0; 2 * count * tile.len()] }
    }

    /// A tile over samples: bands in order, each row by row, all means and then all variances.
    pub(super) fn from_samples(tile: Tile, count: usize, samples: Vec<f32>) -> Self {
        debug_assert_eq!(samples.len(), 2 * count * tile.len(), "two numbers a band and pixel");
        Self { tile, count, samples }
    }

    /// A tile of cubes in memory.
    pub(super) fn from_cubes(tile: Tile, mean: &SpectralCube<Irradiance>, variance: &SpectralCube<Variance>) -> Self {
        let mut samples = Vec::with_capacity(2 * mean.planes().len() * tile.len());
        let width = mean.width();
        let planes = mean.planes().iter().map(Plane::samples).chain(variance.planes().iter().map(Plane::samples));
        for plane in planes {
            for y in tile.y0..tile.y1 {
                samples.extend_from_slice(&plane[y as usize * width..][tile.x0 as usize..tile.x1 as usize]);
            }
        }
        Self { tile, count: mean.planes().len(), samples }
    }

    /// Means of a pixel, shortest wavelength first.
    pub fn means(&self, pixel: Pixel) -> impl Iterator<Item = f32> + '_ {
        self.at(pixel).take(self.count)
    }

    /// Variances of the means of a pixel.
    pub fn variances(&self, pixel: Pixel) -> impl Iterator<Item = f32> + '_ {
        self.at(pixel).skip(self.count)
    }

    /// Stores the light of a pixel.
    pub(super) fn store(&mut self, pixel: Pixel, light: &PixelLight) {
        let place = self.place(pixel);
        let means = light.bands().iter().map(|mean| *mean as f32);
        let variances = light.band_variances().iter().map(|variance| stored_variance(*variance));
        for (plane, value) in self.samples.chunks_exact_mut(self.tile.len()).zip(means.chain(variances)) {
            plane[place] = value;
        }
    }

    pub(super) fn tile(&self) -> Tile {
        self.tile
    }

    /// All samples.
    pub(super) fn samples(&self) -> &[f32] {
        &self.samples
    }

    fn at(&self, pixel: Pixel) -> impl Iterator<Item = f32> + '_ {
        let place = self.place(pixel);
        self.samples.chunks_exact(self.tile.len()).map(move |plane| plane[place])
    }

    fn place(&self, pixel: Pixel) -> usize {
        let Tile { x0, y0, x1, .. } = self.tile;
        ((pixel.y - y0) * (x1 - x0) + pixel.x - x0) as usize
    }
}
