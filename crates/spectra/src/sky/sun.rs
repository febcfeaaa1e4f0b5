//! The Sun through the atmosphere: Hosek & Wilkie (2013).
//!
//! Radiance at the disc's centre, W·m⁻²·sr⁻¹·nm⁻¹, is a cubic in the elevation above the piece's lower end, in each of 45 pieces of equal width in
//! the cube root of elevation/90°. It is linear in turbidity and between bands, and extrapolated beyond them as described in [`continuation`](super).
//! With µ = √(1 − (sin γ/sin R)²) at the angle γ from the centre of a disc of radius R, a point of the disc has that radiance times Σ aₖ µᵏ (k = 0 …
//! 5), which is 1 at the centre; its mean over the disc is Σ 2aₖ/(k + 2). Outside 320–720 nm the limb darkening of the end bands is used.
//!
//! The tables hold the radiance of the real Sun, so the irradiance follows the disc: 0.5338° across. **Below the horizon** there is no direct light:
//! the disc is complete while its centre is at or above the horizon and absent when it is below. The authors evaluate each point of the disc at its
//! own elevation; here the whole disc uses that of its centre. **Left out:** refraction, the flattened disc, the Earth's distance (±3.4 % over the
//! year), spots.

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths;

use super::{BANDS, LIMB, SUN, SkyError, band_below, check_elevation, check_turbidity, sun_spectrum, turbidity_step};
use crate::Spectrum;

/// Diameter of the disc at the Earth's mean distance, degrees.
pub const ANGULAR_DIAMETER_DEG: f64 = 0.5338;

/// Number of elevation pieces.
const PIECES: usize = 45;

/// Spectral radiance at the disc's centre, W·m⁻²·sr⁻¹·nm⁻¹, 300 to 1 100 nm, at a turbidity of 1 to 10 and an elevation of −π/2 to π/2; zero below
/// the horizon.
///
/// # Errors
/// If a number is out of range.
pub fn radiance(turbidity: f64, elevation_rad: f64) -> Result<Spectrum, SkyError> {
    Ok(sun_spectrum(&band_radiances(turbidity, elevation_rad)?))
}

/// Radiance at the disc's centre in each band, W·m⁻²·sr⁻¹·nm⁻¹.
///
/// # Errors
/// If a number is out of range.
pub fn band_radiances(turbidity: f64, elevation_rad: f64) -> Result<[f64; BANDS], SkyError> {
    check_turbidity(turbidity)?;
    check_elevation(elevation_rad)?;
    if elevation_rad < 0.0 {
        return Ok([0.0; BANDS]);
    }
    let (low, t) = turbidity_step(turbidity);
    let (piece, above) = piece(elevation_rad);
    let at = |step, band| cubic((step * PIECES + piece) * 4, band, above);
    Ok(core::array::from_fn(|band| ((1.0 - t) * at(low, band) + t * at(low + 1, band)).max(0.0)))
}

/// The piece of an elevation, and the elevation above the piece's lower end.
fn piece(elevation_rad: f64) -> (usize, f64) {
    let x = maths::f64::cbrt(elevation_rad / FRAC_PI_2) * PIECES as f64;
    let piece = (x as usize).min(PIECES - 1);
    let low = piece as f64 / PIECES as f64;
    (piece, elevation_rad - low * low * low * FRAC_PI_2)
}

/// The cubic whose coefficients start at a row, highest power first.
fn cubic(row: usize, band: usize, x: f64) -> f64 {
    SUN[row..row + 4].iter().fold(0.0, |sum, coefficients| sum * x + coefficients[band])
}

/// Radiance at a point of the disc over that at its centre, at a wavelength (nm); `mu` is the cosine of the angle at
/// which light leaves the Sun: 1 at the centre, 0 at the limb.
#[must_use]
pub fn limb_darkening(nm: f64, mu: f64) -> f64 {
    limb(nm).iter().rev().fold(0.0, |sum, a| sum * mu + a)
}

/// Mean radiance of the disc over that at its centre, at a wavelength (nm).
#[must_use]
pub fn limb_mean(nm: f64) -> f64 {
    limb(nm).iter().zip(2..).map(|(a, power)| 2.0 * a / f64::from(power)).sum()
}

/// The limb's polynomial at a wavelength (nm), lowest power first.
#[must_use]
pub fn limb(nm: f64) -> [f64; 6] {
    let (band, t) = band_below(nm);
    core::array::from_fn(|k| (1.0 - t) * LIMB[band][k] + t * LIMB[band + 1][k])
}

/// Mean spectral radiance over the disc, W·m⁻²·sr⁻¹·nm⁻¹.
///
/// # Errors
/// If a number is out of range.
pub fn mean_radiance(turbidity: f64, elevation_rad: f64) -> Result<Spectrum, SkyError> {
    Ok(radiance(turbidity, elevation_rad)?.product(&Spectrum::from_fn(limb_mean)))
}

/// Spectral irradiance of a plane facing the Sun, W·m⁻²·nm⁻¹: π sin²R times the mean radiance.
///
/// # Errors
/// If a number is out of range.
pub fn normal_irradiance(turbidity: f64, elevation_rad: f64) -> Result<Spectrum, SkyError> {
    let sin = maths::f64::sin(0.5 * ANGULAR_DIAMETER_DEG.to_radians());
    Ok(mean_radiance(turbidity, elevation_rad)?.scaled(PI * sin * sin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::luminance;
    use crate::sky::SkyModel;

    fn clear(elevation_deg: f64) -> [f64; BANDS] {
        band_radiances(2.0, elevation_deg.to_radians()).expect("in range")
    }

    #[test]
    fn a_turbidity_and_elevation_of_the_table_give_the_tables_cubic() {
        let actual = band_radiances(3.0, FRAC_PI_2).expect("in range");
        let low = 44.0 / 45.0;
        let x = FRAC_PI_2 * (1.0 - low * low * low);
        for (band, actual) in actual.iter().enumerate() {
            let [a, b, c, d] = core::array::from_fn(|k| SUN[(2 * PIECES + 44) * 4 + k][band]);
            let by_hand = a * x * x * x + b * x * x + c * x + d;
            assert!((actual / by_hand - 1.0).abs() < 1e-12);
        }
    }

    /// The fit is continuous across its pieces.
    #[test]
    fn pieces_meet() {
        for number in 1..PIECES {
            let edge = 90.0
                * (number as f64 / PIECES as f64)
                * (number as f64 / PIECES as f64)
                * (number as f64 / PIECES as f64);
            let (below, above) = (clear(edge * (1.0 - 1e-9)), clear(edge * (1.0 + 1e-9)));
            let top = above.iter().fold(0.0, |top: f64, v| top.max(*v));
            for (a, b) in below.iter().zip(&above) {
                // The tables' seven digits, which cancel in pieces near the horizon.
                assert!((a - b).abs() < 1e-3 * top, "{edge}°: {below:?} {above:?}");
            }
        }
    }

    #[test]
    fn the_limb_is_one_at_the_centre_and_its_mean_is_an_integral() {
        for nm in [300.0, 320.0, 433.0, 560.0, 720.0, 1100.0] {
            // Limited by the authors' six digits and their fit.
            assert!((limb_darkening(nm, 1.0) - 1.0).abs() < 2e-3, "{nm} nm");
            assert!((0..100).map(|i| limb_darkening(nm, f64::from(i) / 100.0)).is_sorted(), "{nm} nm");
            let n = 2000;
            // Rings of equal area: r² = 1 − µ² is uniform; the root at the limb costs n^(−3/2).
            let mean: f64 = (0..n).map(|i| limb_darkening(nm, ((f64::from(i) + 0.5) / f64::from(n)).sqrt())).sum();
            assert!((mean / f64::from(n) - limb_mean(nm)).abs() < 2e-5, "{nm} nm");
        }
        assert_eq!((limb(300.0), limb(900.0)), (LIMB[0], LIMB[10]));
    }

    /// The bounds of the issue: clear sun at 60°, turbidity 2.
    #[test]
    fn a_clear_sun_is_as_bright_as_the_sun() {
        let e = 60f64.to_radians();
        let centre = luminance(&radiance(2.0, e).expect("in range"));
        let mean = luminance(&mean_radiance(2.0, e).expect("in range"));
        assert!((centre / 1.6e9 - 1.0).abs() < 0.03 && (mean / 1.3e9 - 1.0).abs() < 0.03, "{centre} {mean}");
        let direct = luminance(&normal_irradiance(2.0, e).expect("in range")) * maths::f64::sin(e);
        let sky = SkyModel::new(2.0, 0.2, e).expect("in range").horizontal_illuminance();
        assert!((85e3..110e3).contains(&(direct + sky)), "{direct} lx and {sky} lx");
    }

    /// Through 1.5 air masses, compared with the standard's direct light, which has more haze (aerosol depth 0.084 at 500 nm) and 2.5° of glow about
    /// the disc.
    #[test]
    fn the_sun_is_near_the_standards() {
        let actual = normal_irradiance(2.0, 41.8f64.to_radians()).expect("in range").integral(360.0, 1100.0);
        let standard = crate::illuminant::solar().direct.integral(360.0, 1100.0);
        assert!((0.8..1.0).contains(&(actual / standard)), "{actual} W/m² against {standard}");
    }

    #[test]
    fn light_grows_with_elevation_and_clear_air_and_ends_at_the_horizon() {
        assert_eq!(radiance(2.0, -1e-9).expect("in range").max_value(), 0.0);
        let lux = |t: f64, e: f64| luminance(&radiance(t, e.to_radians()).expect("in range"));
        assert!((0..=40).map(|i| lux(3.0, f64::from(i * i) * 90.0 / 1600.0)).is_sorted());
        assert!((2..=20).map(|i| lux(f64::from(i) / 2.0, 30.0)).is_sorted_by(|a, b| b <= a));
        for elevation in [0.0, 0.01, 0.5, 3.0] {
            assert!(radiance(9.7, f64::to_radians(elevation)).expect("in range").min_value() >= 0.0);
        }
    }
}
