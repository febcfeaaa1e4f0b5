//! The Sun through the atmosphere: Hosek & Wilkie (2013).
//!
//! Radiance at the disc's centre, W·m⁻²·sr⁻¹·nm⁻¹, is a cubic in the elevation above the piece's lower end, in each of
//! 45 pieces of equal width in the cube root of elevation/90°; linear in turbidity and between bands, continued beyond
//! them as [`continuation`](super::continuation) says. With µ = √(1 − (sin γ/sin R)²) at the angle γ from the centre of
//! a disc of radius R, a point of the disc has that radiance times Σ aₖ µᵏ (k = 0 … 5), which is 1 at the centre; its
//! mean over the disc is Σ 2aₖ/(k + 2). Outside 320–720 nm the end bands' limb is held.
//!
//! The tables hold the radiance of the real Sun, so the irradiance follows the disc: 0.5338° across.
//! **Below the horizon** there is no direct light: the disc is whole while its centre stands at or above the horizon
//! and gone when it stands below. **Left out:** refraction, the flattened disc, the Earth's distance (±3.4 % over the
//! year), spots.

use super::continuation::{band_below, sun_spectrum};
use super::tables::{LIMB, SUN};
use super::{BANDS, SkyError, check_elevation, check_turbidity, turbidity_step};
use crate::Spectrum;
use core::f64::consts::{FRAC_PI_2, PI};
use etendue_core::maths;

/// Diameter of the disc at the Earth's mean distance, degrees.
pub const ANGULAR_DIAMETER_DEG: f64 = 0.5338;

/// Pieces of the elevation.
const PIECES: usize = 45;

/// Spectral radiance at the disc's centre, W·m⁻²·sr⁻¹·nm⁻¹, 300 to 1 100 nm, at a turbidity of 1 to 10 and an elevation
/// of −π/2 to π/2; zero below the horizon.
///
/// # Errors
/// Where a number is out of range.
pub fn radiance(turbidity: f64, elevation_rad: f64) -> Result<Spectrum, SkyError> {
    Ok(sun_spectrum(&band_radiances(turbidity, elevation_rad)?))
}

/// Radiance at the disc's centre in each band, W·m⁻²·sr⁻¹·nm⁻¹.
///
/// # Errors
/// Where a number is out of range.
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

/// Spectral radiance in the mean over the disc, W·m⁻²·sr⁻¹·nm⁻¹.
///
/// # Errors
/// Where a number is out of range.
pub fn mean_radiance(turbidity: f64, elevation_rad: f64) -> Result<Spectrum, SkyError> {
    Ok(radiance(turbidity, elevation_rad)?.product(&Spectrum::from_fn(limb_mean)))
}

/// Spectral irradiance of a plane that faces the Sun, W·m⁻²·nm⁻¹: π sin²R times the mean radiance.
///
/// # Errors
/// Where a number is out of range.
pub fn normal_irradiance(turbidity: f64, elevation_rad: f64) -> Result<Spectrum, SkyError> {
    let sin = maths::f64::sin(0.5 * ANGULAR_DIAMETER_DEG.to_radians());
    Ok(mean_radiance(turbidity, elevation_rad)?.scaled(PI * sin * sin))
}
