//! Responsivities of the pixels of a colour filter's tile, and the density of their wavelengths.
//!
//! Responsivities are per second of exposure, so that cameras that differ only in exposure accumulate the same values.
//!
//! A pixel that weights radiance by its responsivity and accumulates electrons samples its wavelengths by it ([`PixelDensity`]). Electrons are then an
//! estimate with little spectral noise; if a spectral cube is stored as well, every band still receives its fraction.

use crate::plan::pixel_density::PixelDensity;
use etendue_core::WavelengthDensity;
use etendue_core::random::Pixel;
use etendue_sensor::Sensor;
use etendue_spectra::Spectrum;

/// One pixel of the tile.
#[derive(Clone, Debug)]
pub struct Site {
    /// Responsivity, e⁻·s⁻¹ per W·m⁻².
    pub responsivity: Spectrum,
    /// Density of the sampled wavelengths.
    pub density: WavelengthDensity,
}

/// The tile of a colour filter, repeated over the sensor.
#[derive(Clone, Debug)]
pub struct Mosaic {
    columns: usize,
    /// Columns and rows of the film before the first of the sensor.
    margin_px: [usize; 2],
    sites: Vec<Site>,
}

impl Mosaic {
    /// Tile of a sensor whose pixels' wavelengths are sampled with these densities.
    #[must_use]
    pub fn new(sensor: &Sensor, density: &PixelDensity<'_>) -> Self {
        let cfa = &sensor.parameters().cfa;
        let channel = |responsivity: Spectrum| Site { density: density.density(&responsivity), responsivity };
        let channels: Vec<Site> = sensor.rate_responsivities().into_iter().map(channel).collect();
        let sites = cfa.channels().iter().map(|channel| channels[*channel].clone()).collect();
        Self { columns: cfa.width(), margin_px: [0, 0], sites }
    }

    /// The mosaic for a film that starts `margin_px` columns and rows before the sensor.
    #[must_use]
    pub fn beyond(self, margin_px: [usize; 2]) -> Self {
        Self { margin_px, ..self }
    }

    /// Site of a `pixel` of the film.
    #[must_use]
    pub fn at(&self, pixel: Pixel) -> &Site {
        &self.sites[self.place(pixel)]
    }

    /// Number of pixels of the tile.
    #[must_use]
    pub fn places(&self) -> usize {
        self.sites.len()
    }

    /// Index of `pixel` in the tile, row by row.
    #[must_use]
    pub fn place(&self, pixel: Pixel) -> usize {
        let rows = self.sites.len() / self.columns;
        let [x, y] = self.margin_px;
        let column = (pixel.x as usize + self.columns - x % self.columns) % self.columns;
        let row = (pixel.y as usize + rows - y % rows) % rows;
        row * self.columns + column
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_moves_the_tile() {
        let site = || Site {
            responsivity: Spectrum::constant(1.0),
            density: WavelengthDensity::new(&[1.0], 400.0, 700.0).expect("a weight"),
        };
        let mosaic =
            Mosaic { columns: 2, margin_px: [0, 0], sites: vec![site(), site(), site(), site()] }.beyond([3, 2]);
        let places = |x: u32, y: u32| mosaic.place(Pixel { x, y });
        assert_eq!([places(3, 2), places(4, 2), places(3, 3), places(0, 0), places(1, 1)], [0, 1, 2, 1, 2]);
    }
}
