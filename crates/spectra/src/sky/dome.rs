//! The radiance of the sky's dome.

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths;

use super::{
    BANDS, BandRow, BandWeights, MEANS, SHAPES, SkyError, check_albedo, check_elevation, check_turbidity, sky_spectrum,
    turbidity_step,
};
use crate::Spectrum;

/// One band of a sky; its radiance is a product of functions of one angle each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyBand {
    /// A, B, C, D, E, F, G, I, H, in the order of the authors' tables.
    shape: [f64; 9],
    /// L̄, W·m⁻²·sr⁻¹·nm⁻¹.
    scale: f64,
}

impl SkyBand {
    /// L̄, W·m⁻²·sr⁻¹·nm⁻¹.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// 1 + A e^(B/(cos θ + 0.01)): gradient from zenith to horizon.
    #[must_use]
    pub fn gradient(&self, cos_zenith: f64) -> f64 {
        1.0 + self.shape[0] * maths::f64::exp(self.shape[1] / (cos_zenith + 0.01))
    }

    /// C + D e^(Eγ) + F cos²γ + G χ(H, γ): glow about the Sun.
    #[must_use]
    pub fn glow(&self, cos_sun: f64) -> f64 {
        let [_, _, c, d, e, f, g, _, h] = self.shape;
        let cos_sun = cos_sun.clamp(-1.0, 1.0);
        let cos_2 = cos_sun * cos_sun;
        let base = 1.0 + h * h - 2.0 * h * cos_sun;
        c + d * maths::f64::exp(e * maths::f64::acos(cos_sun)) + f * cos_2 + g * (1.0 + cos_2) / (base * base.sqrt())
    }

    /// I √cos θ.
    #[must_use]
    pub fn rise(&self, cos_zenith: f64) -> f64 {
        self.shape[7] * cos_zenith.sqrt()
    }

    /// Radiance, W·m⁻²·sr⁻¹·nm⁻¹: scale · gradient · (glow + rise), not below zero; zero below the horizon.
    #[must_use]
    pub fn radiance(&self, cos_zenith: f64, cos_sun: f64) -> f64 {
        if cos_zenith < 0.0 {
            return 0.0;
        }
        (self.scale * self.gradient(cos_zenith) * (self.glow(cos_sun) + self.rise(cos_zenith))).max(0.0)
    }
}

/// A clear sky.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyModel {
    bands: [SkyBand; BANDS],
    glow_elevation_rad: f64,
}

impl SkyModel {
    /// Creates the sky at a turbidity of 1 to 10, over ground of an albedo of 0 to 1, with the Sun at an elevation of −π/2 to π/2; for the Sun below
    /// the horizon see [`sky`](super).
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn new(turbidity: f64, ground_albedo: f64, sun_elevation_rad: f64) -> Result<Self, SkyError> {
        check_turbidity(turbidity)?;
        check_albedo(ground_albedo)?;
        check_elevation(sun_elevation_rad)?;
        let sky = Self::day(turbidity, ground_albedo, sun_elevation_rad.max(0.0));
        Ok(if sun_elevation_rad < 0.0 { sky.dimmed(sun_elevation_rad) } else { sky })
    }

    fn day(turbidity: f64, albedo: f64, elevation_rad: f64) -> Self {
        let corner = CornerWeights::new(turbidity, albedo, elevation_rad);
        let band = |b| SkyBand {
            shape: core::array::from_fn(|k| corner.value(&SHAPES, 9, k, b)),
            scale: corner.value(&MEANS, 1, 0, b),
        };
        Self { bands: core::array::from_fn(band), glow_elevation_rad: elevation_rad }
    }

    fn dimmed(mut self, elevation_rad: f64) -> Self {
        let factor = super::factor(self.horizontal_illuminance(), elevation_rad.to_degrees());
        self.bands.iter_mut().for_each(|band| band.scale *= factor);
        self
    }

    /// The bands, at 320, 360, … 720 nm.
    #[must_use]
    pub fn bands(&self) -> &[SkyBand; BANDS] {
        &self.bands
    }

    /// Elevation of the point from which γ is measured: the Sun, or the horizon point above it if it has set.
    #[must_use]
    pub fn glow_elevation_rad(&self) -> f64 {
        self.glow_elevation_rad
    }

    /// The mix of bands at a wavelength (nm); the same for all skies.
    #[must_use]
    pub fn mix(nm: f64) -> BandWeights {
        super::sky(nm)
    }

    /// Radiance of every band in a direction, W·m⁻²·sr⁻¹·nm⁻¹.
    #[must_use]
    pub fn band_radiances(&self, cos_zenith: f64, cos_sun: f64) -> [f64; BANDS] {
        self.bands.map(|band| band.radiance(cos_zenith, cos_sun))
    }

    /// Spectral radiance in a direction, W·m⁻²·sr⁻¹·nm⁻¹, 300 to 1 100 nm.
    #[must_use]
    pub fn radiance(&self, cos_zenith: f64, cos_sun: f64) -> Spectrum {
        sky_spectrum(&self.band_radiances(cos_zenith, cos_sun))
    }

    /// Spectral irradiance on level ground, W·m⁻²·nm⁻¹: the mean of midpoints in cos²θ and azimuth.
    #[must_use]
    pub fn horizontal_irradiance(&self) -> Spectrum {
        const RINGS: usize = 48;
        const SECTORS: usize = 96;
        let sun = maths::f64::sin_cos(self.glow_elevation_rad);
        let mut sums = [0.0; BANDS];
        for ring in 0..RINGS {
            let cos_zenith = ((ring as f64 + 0.5) / RINGS as f64).sqrt();
            for sector in 0..SECTORS {
                let azimuth = PI * (sector as f64 + 0.5) / SECTORS as f64;
                let values = self.band_radiances(cos_zenith, cos_between(cos_zenith, sun.0, sun.1, azimuth));
                (0..BANDS).for_each(|b| sums[b] += values[b]);
            }
        }
        sky_spectrum(&sums.map(|sum| PI * sum / (RINGS * SECTORS) as f64))
    }

    /// Illuminance of level ground by the sky, lx.
    #[must_use]
    pub fn horizontal_illuminance(&self) -> f64 {
        crate::observer::luminance(&self.horizontal_irradiance())
    }
}

/// Cosine of the angle between a direction and the Sun, given the sine and cosine of the Sun's elevation.
fn cos_between(cos_zenith: f64, sun_sin: f64, sun_cos: f64, azimuth: f64) -> f64 {
    let sin_zenith = (1.0 - cos_zenith * cos_zenith).max(0.0).sqrt();
    cos_zenith * sun_sin + sin_zenith * sun_cos * maths::f64::cos(azimuth)
}

/// Weights of the four corners in albedo and turbidity, and of the six control points of an elevation.
struct CornerWeights {
    weights: [(usize, f64); 4],
    points: [f64; 6],
}

impl CornerWeights {
    fn new(turbidity: f64, albedo: f64, elevation_rad: f64) -> Self {
        let (low, t) = turbidity_step(turbidity);
        let weights = [
            (low, (1.0 - albedo) * (1.0 - t)),
            (low + 1, (1.0 - albedo) * t),
            (low + 10, albedo * (1.0 - t)),
            (low + 11, albedo * t),
        ];
        Self { weights, points: bernstein(maths::f64::cbrt((elevation_rad / FRAC_PI_2).min(1.0))) }
    }

    /// Value `k` of `count` per control point, in a band.
    fn value(&self, table: &[BandRow], count: usize, k: usize, band: usize) -> f64 {
        let curve =
            |corner: usize| -> f64 { (0..6).map(|p| self.points[p] * table[(corner * 6 + p) * count + k][band]).sum() };
        self.weights.iter().map(|(corner, weight)| weight * curve(*corner)).sum()
    }
}

/// Bernstein's polynomials of degree five.
fn bernstein(x: f64) -> [f64; 6] {
    let y = 1.0 - x;
    let (x2, y2) = (x * x, y * y);
    let (x4, y4) = (x2 * x2, y2 * y2);
    [y4 * y, 5.0 * y4 * x, 10.0 * y2 * y * x2, 10.0 * y2 * x2 * x, 5.0 * y * x4, x4 * x]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(turbidity: f64, albedo: f64, elevation_deg: f64) -> SkyModel {
        SkyModel::new(turbidity, albedo, elevation_deg.to_radians()).expect("in range")
    }

    #[test]
    fn control_points_are_the_tables_own() {
        // At the horizon the curve is its first control point, at the zenith its last.
        for (elevation, point) in [(0.0, 0), (90.0, 5)] {
            let sky = model(4.0, 1.0, elevation);
            for (b, band) in sky.bands().iter().enumerate() {
                for k in 0..9 {
                    assert!((band.shape[k] - SHAPES[((10 + 3) * 6 + point) * 9 + k][b]).abs() < 1e-12);
                }
                assert!((band.scale() - MEANS[(10 + 3) * 6 + point][b]).abs() < 1e-15);
            }
        }
        assert!((bernstein(0.3).iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn radiance_is_the_product_of_its_parts_and_never_negative() {
        for (turbidity, elevation) in [(1.0, 0.0), (3.0, 0.0), (7.5, 2.0), (10.0, 40.0), (2.0, 90.0)] {
            let sky = model(turbidity, 0.1, elevation);
            for step in 0..=200 {
                let (zenith, sun) = (f64::from(step) / 200.0, f64::from(step % 41) / 20.0 - 1.0);
                for (band, actual) in sky.bands().iter().zip(sky.band_radiances(zenith, sun)) {
                    let parts = band.scale() * band.gradient(zenith) * (band.glow(sun) + band.rise(zenith));
                    assert!(actual == parts.max(0.0) && actual.is_finite());
                }
            }
            assert_eq!(sky.band_radiances(-0.1, 0.3), [0.0; BANDS], "no sky below the horizon");
        }
    }

    /// Rings of equal projected solid angle: against a plain sum over zenith angle and azimuth, five times as fine.
    #[test]
    fn irradiance_is_an_integral() {
        let sky = model(3.0, 0.3, 25.0);
        let sun = maths::f64::sin_cos(sky.glow_elevation_rad());
        let (mut sum, rings, sectors) = (0.0, 400, 300);
        for ring in 0..rings {
            let (sin, cos) = maths::f64::sin_cos(FRAC_PI_2 * (f64::from(ring) + 0.5) / f64::from(rings));
            for sector in 0..sectors {
                let azimuth = PI * (f64::from(sector) + 0.5) / f64::from(sectors);
                sum += sin * cos * sky.bands()[6].radiance(cos, cos_between(cos, sun.0, sun.1, azimuth));
            }
        }
        let fine = 2.0 * PI * FRAC_PI_2 * sum / f64::from(rings * sectors);
        let actual = f64::from(sky.horizontal_irradiance().at(560.0));
        // The glow within some degrees of the Sun is the finest feature of the sky; a cell is 2° to 4°.
        assert!((actual / fine - 1.0).abs() < 2e-3, "{actual} against {fine}");
    }

    #[test]
    fn a_clear_sky_is_as_bright_as_measured() {
        // A clear sky without its Sun gives 10 to 20 klx by day, as commonly stated; haze and ground add to it.
        let lux =
            [(2.0, 0.0), (2.0, 0.2), (4.0, 0.2), (6.0, 0.2)].map(|(t, a)| model(t, a, 60.0).horizontal_illuminance());
        assert!((10e3..20e3).contains(&lux[1]), "{lux:?}");
        assert!(lux.windows(2).all(|w| w[1] > w[0]), "{lux:?}");
    }

    #[test]
    fn brightness_goes_on_below_the_horizon() {
        let lux = |elevation| model(3.0, 0.2, elevation).horizontal_illuminance();
        // A change of the Sun's elevation by 1e-6°: the cube root of 1e-6/90 is 0.002; the curve changes by some times as much.
        assert!((lux(-1e-6) / lux(1e-6) - 1.0).abs() < 0.02, "{} and {}", lux(-1e-6), lux(1e-6));
        assert!((lux(-1e-6) / lux(0.0) - 1.0).abs() < 1e-6);
        for elevation in [-6.0, -9.0, -15.0, -18.0, -50.0, -90.0] {
            assert!((lux(elevation) / super::super::illuminance(elevation) - 1.0).abs() < 1e-6, "{elevation}°");
        }
        assert!((0..40).map(|i| lux(-0.5 * f64::from(i))).is_sorted_by(|a, b| b <= a), "it grows dark");
        assert_eq!(model(3.0, 0.2, -4.0).glow_elevation_rad(), 0.0);
    }
}
