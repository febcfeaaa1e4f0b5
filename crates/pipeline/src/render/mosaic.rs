//! What the pixels of a colour filter's tile respond to, and which wavelengths are worth asking for them.
//!
//! Responsivities are those of a second of exposure, so that cameras that differ in exposure alone fold the same.
//!
//! A pixel that folds its responsivity R(λ) into electrons draws its wavelengths with a density that is a mixture of
//! R(λ) and of the uniform density: electrons are then an estimate with little spectral noise, and where a spectral cube
//! is kept beside them, every band still gets its share.

use etendue_core::WavelengthDensity;
use etendue_core::random::Pixel;
use etendue_sensor::Sensor;
use etendue_spectra::Spectrum;

/// Width of the density's steps, nm, at most.
const STEP_NM: f64 = 5.0;
/// Share of the uniform density where only electrons are summed: it guards against a step whose mean is far below its
/// peak.
const UNIFORM_SHARE: f64 = 0.05;
/// The same where spectral bands are kept too.
pub(crate) const UNIFORM_SHARE_WITH_BANDS: f64 = 0.5;

/// One pixel of the tile.
#[derive(Clone, Debug)]
pub struct Site {
    /// Responsivity, e⁻·s⁻¹ per W·m⁻².
    pub responsivity: Spectrum,
    /// Density of the wavelengths that are asked for.
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
    /// The tile of a sensor; wavelengths are drawn from `range_nm`, and `keeps_bands` says whether a cube is kept.
    #[must_use]
    pub fn of(sensor: &Sensor, range_nm: (f64, f64), keeps_bands: bool) -> Self {
        let cfa = &sensor.parameters().cfa;
        let rates = sensor.rate_responsivities();
        let uniform_share = if keeps_bands { UNIFORM_SHARE_WITH_BANDS } else { UNIFORM_SHARE };
        let site = |channel: &usize| {
            let responsivity = rates[*channel].clone();
            Site { density: density(&responsivity, range_nm, uniform_share), responsivity }
        };
        Self { columns: cfa.width(), margin_px: [0, 0], sites: cfa.channels().iter().map(site).collect() }
    }

    /// The same for a film that begins `margin_px` columns and rows before the sensor.
    #[must_use]
    pub fn beyond(self, margin_px: [usize; 2]) -> Self {
        Self { margin_px, ..self }
    }

    /// The site that `pixel` of the film has.
    #[must_use]
    pub fn at(&self, pixel: Pixel) -> &Site {
        &self.sites[self.place(pixel)]
    }

    /// Pixels of the tile.
    #[must_use]
    pub fn places(&self) -> usize {
        self.sites.len()
    }

    /// The place of `pixel` in the tile, row by row.
    #[must_use]
    pub fn place(&self, pixel: Pixel) -> usize {
        let rows = self.sites.len() / self.columns;
        let [x, y] = self.margin_px;
        let column = (pixel.x as usize + self.columns - x % self.columns) % self.columns;
        let row = (pixel.y as usize + rows - y % rows) % rows;
        row * self.columns + column
    }
}

fn density(responsivity: &Spectrum, (low_nm, high_nm): (f64, f64), uniform_share: f64) -> WavelengthDensity {
    let steps = ((high_nm - low_nm) / STEP_NM).ceil().max(1.0);
    let edge = |i: f64| low_nm + (high_nm - low_nm) * i / steps;
    let means: Vec<f64> =
        (0..steps as usize).map(|i| responsivity.band_mean(edge(i as f64), edge(i as f64 + 1.0))).collect();
    let mean = means.iter().sum::<f64>() / steps;
    let weight = |m: &f64| match mean > 0.0 {
        true => (uniform_share + (1.0 - uniform_share) * m / mean) as f32,
        false => 1.0,
    };
    let weights: Vec<_> = means.iter().map(weight).collect();
    WavelengthDensity::new(&weights, low_nm as f32, high_nm as f32).expect("weights are positive and finite")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_are_asked_where_a_pixel_responds_and_a_little_everywhere() {
        let green = Spectrum::from_fn(|nm| if (500.0..=600.0).contains(&nm) { 2.0 } else { 0.0 });
        let density = density(&green, (400.0, 700.0), 0.25);
        let (inside, outside) = (300.0 * density.pdf(550.0), 300.0 * density.pdf(430.0));
        // A third of the range holds three quarters of the density beside a quarter spread evenly.
        assert!((inside - (0.25 + 0.75 * 3.0)).abs() < 0.05 && (outside - 0.25).abs() < 0.01, "{inside} {outside}");
    }

    #[test]
    fn a_margin_moves_the_tile() {
        let site = || Site {
            responsivity: Spectrum::constant(1.0),
            density: density(&Spectrum::constant(1.0), (400.0, 700.0), 0.5),
        };
        let mosaic =
            Mosaic { columns: 2, margin_px: [0, 0], sites: vec![site(), site(), site(), site()] }.beyond([3, 2]);
        let places = |x: u32, y: u32| mosaic.place(Pixel { x, y });
        assert_eq!([places(3, 2), places(4, 2), places(3, 3), places(0, 0), places(1, 1)], [0, 1, 2, 1, 2]);
    }

    #[test]
    fn a_pixel_that_responds_to_nothing_draws_uniformly() {
        let density = density(&Spectrum::constant(0.0), (400.0, 700.0), 0.05);
        assert!((300.0 * density.pdf(490.0) - 1.0).abs() < 1e-5);
    }
}
