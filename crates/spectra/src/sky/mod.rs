//! Sun and sky: the clear sky of Hosek & Wilkie (2012) and the Sun through it (Hosek & Wilkie 2013).
//!
//! **Sky.** With θ the angle of a direction from the zenith and γ its angle from the Sun, a band's radiance is
//! L = L̄ · (1 + A e^(B/(cos θ + 0.01))) · (C + D e^(Eγ) + F cos²γ + G χ(H, γ) + I √cos θ), with
//! χ(H, γ) = (1 + cos²γ)/(1 + H² − 2H cos γ)^(3/2), in W·m⁻²·sr⁻¹·nm⁻¹. The nine coefficients and L̄ are tabulated for
//! bands at 320, 360, … 720 nm, turbidity 1, 2, … 10 and ground albedo 0 and 1; between these they are linear, and in
//! the Sun's elevation quintic Bézier curves over the cube root of elevation/90°. Radiance is linear in wavelength
//! between bands. The fit dips below zero in some directions low over the horizon at a low Sun: there it is zero.
//!
//! **Ranges.** Turbidity 1 to 10, albedo 0 to 1, elevation −90° to 90°; 300 to 1 100 nm, see [`continuation`]. The
//! albedo is one number for all bands. Directions below the horizon have no sky: zero.
//!
//! **Below the horizon** the model ends. See [`twilight`] for the sky, [`sun`] for the Sun.
//!
//! **Left out.** Clouds, refraction, altitude, polarisation, ozone and water vapour that vary, the blue hour's colour,
//! city light, Moon and stars but for the floor of the night.
//!
//! Sources: L. Hosek and A. Wilkie, *An Analytic Model for Full Spectral Sky-Dome Radiance*, ACM TOG 31(4), 2012;
//! *Adding a Solar-Radiance Function to the Hošek–Wilkie Skylight Model*, IEEE CG&A 33(3), 2013; the authors' tables,
//! version 1.4a.

pub mod continuation;
mod dome;
pub mod sun;
mod tables;
pub mod twilight;

pub use continuation::Mix;
pub use dome::{SkyBand, SkyModel};

use core::f64::consts::FRAC_PI_2;
use core::ops::RangeInclusive;

/// How many bands the tables have.
pub const BANDS: usize = 11;
/// The first band, nm.
pub const FIRST_NM: f64 = 320.0;
/// The last band, nm.
pub const LAST_NM: f64 = 720.0;
/// From one band to the next, nm.
pub const STEP_NM: f64 = 40.0;
/// Turbidities of the tables.
pub const TURBIDITIES: RangeInclusive<f64> = 1.0..=10.0;

/// Why there is no such sky.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// Turbidity outside the tables.
    #[error(
        "turbidity {found} is outside 1 to 10: 1 is air without haze, 2 very clear, 3 clear, 6 hazy, 10 thick haze"
    )]
    Turbidity {
        /// The number given.
        found: f64,
    },
    /// An albedo that is none.
    #[error("ground albedo {found} is outside 0 to 1: give the share of light that the land around reflects")]
    Albedo {
        /// The number given.
        found: f64,
    },
    /// An elevation that is none.
    #[error("the Sun's elevation of {degrees}° is outside −90° to 90°: give its angle above the horizon")]
    Elevation {
        /// The angle given, degrees.
        degrees: f64,
    },
}

fn check_turbidity(found: f64) -> Result<(), SkyError> {
    if TURBIDITIES.contains(&found) { Ok(()) } else { Err(SkyError::Turbidity { found }) }
}

fn check_albedo(found: f64) -> Result<(), SkyError> {
    if (0.0..=1.0).contains(&found) { Ok(()) } else { Err(SkyError::Albedo { found }) }
}

fn check_elevation(rad: f64) -> Result<(), SkyError> {
    // A hair more than 90°, for angles that were converted.
    if rad.abs() <= FRAC_PI_2 + 1e-12 { Ok(()) } else { Err(SkyError::Elevation { degrees: rad.to_degrees() }) }
}

/// The table's turbidity at or below, counted from 0 and never the last, and how far on it lies.
fn turbidity_step(turbidity: f64) -> (usize, f64) {
    let low = ((turbidity - 1.0) as usize).min(8);
    (low, turbidity - 1.0 - low as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn out_of_range_is_told() {
        let error = |t: f64, a: f64, e: f64| SkyModel::new(t, a, e).expect_err("out of range").to_string();
        assert!(error(0.5, 0.2, 1.0).starts_with("turbidity 0.5 is outside 1 to 10"));
        assert!(error(f64::NAN, 0.2, 1.0).starts_with("turbidity NaN"));
        assert!(error(3.0, 1.5, 1.0).starts_with("ground albedo 1.5 is outside 0 to 1"));
        assert!(error(3.0, 0.2, 100f64.to_radians()).starts_with("the Sun's elevation of 100"));
        assert!(sun::radiance(11.0, 1.0).is_err() && sun::radiance(3.0, f64::INFINITY).is_err());
        assert!(sun::radiance(10.0, FRAC_PI_2).is_ok() && SkyModel::new(1.0, 1.0, -FRAC_PI_2).is_ok());
    }

    #[test]
    fn turbidities_between() {
        assert_eq!([1.0, 1.25, 9.0, 10.0].map(turbidity_step), [(0, 0.0), (0, 0.25), (8, 0.0), (8, 1.0)]);
    }
}
