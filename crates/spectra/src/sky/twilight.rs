//! The sky when the Sun is below the horizon: a stated fallback, right in brightness and not in form or colour.
//!
//! The sky of a Sun at the horizon is scaled so that level ground receives the published illuminance of a clear sky at
//! the Sun's depression: log₁₀ E = Σ lₖ xᵏ with E in lx and x = elevation/90°, fitted piecewise to measurements
//! (Janiczek & DeYoung 1987, U.S. Naval Observatory Circular 171; also Urban & Seidelmann 2013, p. 518). It gives
//! 750 lx at the horizon, 3.4 lx at −6°, 0.008 lx at −12° and 6.5·10⁻⁴ lx at −18°. Below −18° the sky keeps that last
//! value, about that of a moonless, starlit night.
//!
//! The model's own sky at the horizon differs from the published one, so that their ratio, to the power 1 − d/6°, is
//! kept down to a depression d of 6°: brightness goes on without a step and is the published one from there on.
//!
//! **Left out:** the glow's true form, the Earth's shadow, the blue of ozone, Moon, city light.

use etendue_core::maths;

/// Lowest elevation at which a fit ends, degrees, and the fit.
const FITS: [(f64, [f64; 4]); 3] = [
    (-5.0, [2.88, 21.81, -258.11, -858.36]),
    (-12.0, [2.70, 12.17, -431.69, -1899.83]),
    (NIGHT_DEG, [13.84, 262.72, 1447.42, 2797.93]),
];

/// From here down the sky stays as it is, degrees.
pub const NIGHT_DEG: f64 = -18.0;

/// From here down the illuminance is the published one, degrees.
const PUBLISHED_DEG: f64 = -6.0;

/// Illuminance of level ground under a clear sky with the Sun at an elevation of 0° or below, lx.
#[must_use]
pub fn illuminance(elevation_deg: f64) -> f64 {
    let degrees = elevation_deg.clamp(NIGHT_DEG, 0.0);
    let fit = FITS.iter().find(|(low, _)| degrees >= *low).map_or(FITS[2].1, |(_, fit)| *fit);
    let x = degrees / 90.0;
    maths::f64::pow(10.0, fit.iter().rev().fold(0.0, |sum, l| sum * x + l))
}

/// What scales a sky that gives `horizon_lx` with the Sun at the horizon.
pub(super) fn factor(horizon_lx: f64, elevation_deg: f64) -> f64 {
    let kept = (1.0 - elevation_deg / PUBLISHED_DEG).max(0.0);
    let ratio = maths::f64::pow(horizon_lx / illuminance(0.0), kept);
    illuminance(elevation_deg) * ratio / horizon_lx
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_figures() {
        // Illuminances commonly stated for these moments: 759, 3.4, 8.3e-3 and 6.5e-4 lx; fits of such data are good to 0.03
        // in the logarithm.
        for (degrees, lux) in [(0.0, 759.0), (-6.0, 3.4), (-12.0, 8.3e-3), (-18.0, 6.5e-4)] {
            let off = maths::f64::log10(illuminance(degrees) / lux);
            assert!(off.abs() < 0.03, "{degrees}°: {}", illuminance(degrees));
        }
        assert_eq!(illuminance(-60.0), illuminance(-18.0));
    }

    #[test]
    fn fits_meet() {
        for degrees in [-5.0, -12.0, -18.0] {
            // As good as the fits themselves.
            let step = maths::f64::log10(illuminance(degrees - 1e-9) / illuminance(degrees + 1e-9));
            assert!(step.abs() < 0.03, "{degrees}°: {step}");
        }
    }
}
