//! Sun and sky: the clear sky of Hosek & Wilkie (2012) and the Sun through it (Hosek & Wilkie 2013).
//!
//! **Sky.** With θ the angle of a direction from the zenith and γ its angle from the Sun, a band's radiance is L = L̄ · (1 + A e^(B/(cos θ + 0.01)))
//! · (C + D e^(Eγ) + F cos²γ + G χ(H, γ) + I √cos θ), with χ(H, γ) = (1 + cos²γ)/(1 + H² − 2H cos γ)^(3/2), in W·m⁻²·sr⁻¹·nm⁻¹. The nine coefficients
//! and L̄ are tabulated for bands at 320, 360, … 720 nm, turbidity 1, 2, … 10 and ground albedo 0 and 1. They are linear between these, and quintic
//! Bézier curves over the cube root of elevation/90° in the Sun's elevation. Radiance is linear in wavelength between bands. The fit is negative in
//! some directions near the horizon at a low Sun: there the radiance is zero.
//!
//! **Ranges.** Turbidity 1 to 10, albedo 0 to 1, elevation −90° to 90°; 300 to 1 100 nm, continued as described below. The albedo is one number for
//! all bands. The radiance of directions below the horizon is zero.
//!
//! **Sun below the horizon**: outside the model. See below for the sky, [`mod@sun`] for the Sun.
//!
//! **Left out.** Clouds, refraction, altitude, polarisation, variable ozone and water vapour, the colour of twilight, city light, Moon and stars
//! (except for the minimum brightness at night).
//!
//! Sources: L. Hosek and A. Wilkie, *An Analytic Model for Full Spectral Sky-Dome Radiance*, ACM TOG 31(4), 2012;
//! *Adding a Solar-Radiance Function to the Hošek–Wilkie Skylight Model*, IEEE CG&A 33(3), 2013; the authors' tables,
//! version 1.4a.
//!
//! The sky with the Sun below the horizon: a documented fallback, correct in brightness but not in form or colour.
//!
//! The sky of a Sun at the horizon is scaled so that level ground receives the published illuminance of a clear sky at
//! the Sun's depression: log₁₀ E = Σ lₖ xᵏ with E in lx and x = elevation/90°, fitted piecewise to measurements
//! (Janiczek & DeYoung 1987, U.S. Naval Observatory Circular 171; also Urban & Seidelmann 2013, p. 518). It gives
//! 750 lx at the horizon, 3.4 lx at −6°, 0.008 lx at −12° and 6.5·10⁻⁴ lx at −18°. Below −18° the sky keeps that last
//! value, about that of a moonless, starlit night.
//!
//! The model's own sky at the horizon differs from the published one. Their ratio, to the power 1 − d/6°, is applied down to a depression d of 6°:
//! brightness is continuous and equals the published one from there on.
//!
//! **Left out:** the glow's true form, the Earth's shadow, the blue of ozone, Moon, city light.
//!
//! Spectral interpolation between the bands, and extrapolation to 300 and 1 100 nm.
//!
//! Between 320 and 720 nm radiance is linear between bands. Beyond, it has the shape of ASTM G-173: direct light for the Sun, global less direct
//! light for the sky, at the scale L(λ) = L(band) · S(λ)/S̄(band), with S̄ the mean of the shape S over the outermost band:
//!
//! - **320 nm**: with the triangular weight 1 − |λ − 320 nm|/20 nm (300–340 nm: the shape has no data below);
//! - **720 nm**: with the triangular weight 1 − |λ − 720 nm|/40 nm (680–760 nm, the band's own weight in the interpolation), leaving out 686–695 nm
//!   and 714–735 nm, the absorption bands of oxygen and water, which the model's tables do not contain.
//!
//! Band means are therefore continuous, while the shape's own absorption lines remain: the end of a water band lies just above 720 nm, which the
//! model below lacks.
//!
//! **Left out.** The shape is that of one air mass (1.5), one turbidity and one albedo; a low Sun is redder beyond 720 nm. The global light of the
//! standard falls on a plane tilted 37° and includes light from the ground. Source: ASTM G-173-03 (2012).

mod dome;
pub mod sun;

use core::{f64::consts::FRAC_PI_2, ops::RangeInclusive};
use std::sync::LazyLock;

use etendue_core::maths;

use crate::spectrum::{NODES, node_nm};
use crate::{Spectrum, illuminant, table};

pub use dome::{SkyBand, SkyModel};

/// Number of bands in the tables.
pub const BANDS: usize = 11;
/// The first band, nm.
pub const FIRST_NM: f64 = 320.0;
/// The last band, nm.
pub const LAST_NM: f64 = 720.0;
/// Distance between bands, nm.
pub const STEP_NM: f64 = 40.0;
/// Turbidities of the tables.
pub const TURBIDITIES: RangeInclusive<f64> = 1.0..=10.0;

/// Error of a sky's parameters.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// Turbidity outside the tables.
    #[error(
        "turbidity {value} is outside 1 to 10: 1 is air without haze, 2 very clear, 3 clear, 6 hazy, 10 thick haze"
    )]
    Turbidity {
        /// Value given.
        value: f64,
    },
    /// An albedo outside 0 to 1.
    #[error("ground albedo {value} is outside 0 to 1: give the fraction of light that the surrounding ground reflects")]
    Albedo {
        /// Value given.
        value: f64,
    },
    /// An elevation outside −90° to 90°.
    #[error("the Sun's elevation of {degrees}° is outside −90° to 90°: give its angle above the horizon")]
    Elevation {
        /// Angle given, degrees.
        degrees: f64,
    },
}

fn check_turbidity(turbidity: f64) -> Result<(), SkyError> {
    if TURBIDITIES.contains(&turbidity) { Ok(()) } else { Err(SkyError::Turbidity { value: turbidity }) }
}

fn check_albedo(albedo: f64) -> Result<(), SkyError> {
    if (0.0..=1.0).contains(&albedo) { Ok(()) } else { Err(SkyError::Albedo { value: albedo }) }
}

fn check_elevation(rad: f64) -> Result<(), SkyError> {
    // Slightly more than 90° is accepted, for converted angles.
    if rad.abs() <= FRAC_PI_2 + 1e-12 { Ok(()) } else { Err(SkyError::Elevation { degrees: rad.to_degrees() }) }
}

/// The table's turbidity at or below, counted from 0 and never the last, and the fraction towards the next.
fn turbidity_step(turbidity: f64) -> (usize, f64) {
    let low = ((turbidity - 1.0) as usize).min(8);
    (low, turbidity - 1.0 - low as f64)
}

/// One row of a table: a value per band.
type BandRow = [f64; BANDS];

fn rows(text: &str) -> Vec<BandRow> {
    let rows = table::rows::<BANDS>(text).expect("a table of the crate has a number for each band");
    rows.into_iter().map(|(_, row)| row).collect()
}

/// Coefficients of the sky's shape: albedo {0, 1} × turbidity {1 … 10} × 6 control points × 9 (fastest).
static SHAPES: LazyLock<Vec<BandRow>> =
    LazyLock::new(|| rows(include_str!("../../data/hosek_wilkie/sky_coefficients.csv")));

/// Mean radiances of the sky: albedo {0, 1} × turbidity {1 … 10} × 6 control points (fastest), W·m⁻²·sr⁻¹·nm⁻¹.
static MEANS: LazyLock<Vec<BandRow>> = LazyLock::new(|| rows(include_str!("../../data/hosek_wilkie/sky_radiance.csv")));

/// The Sun's radiance: turbidity {1 … 10} × 45 pieces × 4 coefficients, highest power first (fastest).
static SUN: LazyLock<Vec<BandRow>> = LazyLock::new(|| rows(include_str!("../../data/hosek_wilkie/sun_radiance.csv")));

/// Limb darkening: for each band the coefficients of powers 0 to 5.
static LIMB: LazyLock<Vec<[f64; 6]>> = LazyLock::new(|| {
    let text = include_str!("../../data/hosek_wilkie/limb_darkening.csv");
    let rows = table::rows::<7>(text).expect("a table of the crate has seven columns");
    rows.into_iter().map(|(_, [_nm, powers @ ..])| powers).collect()
});

/// Lower limit of each fit's elevation, degrees, and the fit.
const FITS: [(f64, [f64; 4]); 3] = [
    (-5.0, [2.88, 21.81, -258.11, -858.36]),
    (-12.0, [2.70, 12.17, -431.69, -1899.83]),
    (NIGHT_DEG, [13.84, 262.72, 1447.42, 2797.93]),
];

/// Elevation below which the sky is constant, degrees.
pub const NIGHT_DEG: f64 = -18.0;

/// Elevation below which the illuminance is the published one, degrees.
const PUBLISHED_DEG: f64 = -6.0;

/// Illuminance of level ground under a clear sky with the Sun at an elevation of 0° or below, lx.
#[must_use]
pub fn illuminance(elevation_deg: f64) -> f64 {
    let degrees = elevation_deg.clamp(NIGHT_DEG, 0.0);
    let fit = FITS.iter().find(|(low, _)| degrees >= *low).map_or(FITS[2].1, |(_, fit)| *fit);
    let x = degrees / 90.0;
    maths::f64::pow(10.0, fit.iter().rev().fold(0.0, |sum, l| sum * x + l))
}

/// Scale factor of a sky that gives `horizon_lx` with the Sun at the horizon.
fn factor(horizon_lx: f64, elevation_deg: f64) -> f64 {
    let fraction = (1.0 - elevation_deg / PUBLISHED_DEG).max(0.0);
    let ratio = maths::f64::pow(horizon_lx / illuminance(0.0), fraction);
    illuminance(elevation_deg) * ratio / horizon_lx
}

/// Absorption bands of oxygen and water, excluded from means, nm.
const GAS_NM: [(f64, f64); 2] = [(686.0, 695.0), (714.0, 735.0)];

/// Weights of two neighbouring bands for the radiance at a wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandWeights {
    /// The lower band.
    pub band: usize,
    /// Weights of that band and the next.
    pub weights: [f64; 2],
}

impl BandWeights {
    /// The mix of one value per band.
    #[must_use]
    pub fn apply(&self, values: &[f64; BANDS]) -> f64 {
        self.weights[0] * values[self.band] + self.weights[1] * values[self.band + 1]
    }
}

/// The mix of bands at a wavelength (nm, 300 to 1 100) of the sky's light.
#[must_use]
pub fn sky(nm: f64) -> BandWeights {
    mix(nm, &SKY)
}

/// The mix of bands at a wavelength (nm, 300 to 1 100) of the Sun's light.
#[must_use]
pub fn sun(nm: f64) -> BandWeights {
    mix(nm, &CONTINUATION_SUN)
}

/// The sky's spectrum from one value per band.
#[must_use]
pub fn sky_spectrum(values: &[f64; BANDS]) -> Spectrum {
    Spectrum::from_fn(|nm| sky(nm).apply(values))
}

/// The Sun's spectrum from one value per band.
#[must_use]
pub fn sun_spectrum(values: &[f64; BANDS]) -> Spectrum {
    Spectrum::from_fn(|nm| sun(nm).apply(values))
}

/// The shape beyond both ends, relative to the band there.
struct ContinuationShape {
    below: Spectrum,
    above: Spectrum,
}

static CONTINUATION_SUN: LazyLock<ContinuationShape> = LazyLock::new(|| shape(&illuminant::solar().direct));

static SKY: LazyLock<ContinuationShape> = LazyLock::new(|| {
    let solar = illuminant::solar();
    shape(&Spectrum::from_fn(|nm| f64::from(solar.global_tilt.at(nm as f32) - solar.direct.at(nm as f32))))
});

fn shape(light: &Spectrum) -> ContinuationShape {
    let relative = |centre_nm, half_nm| light.scaled(1.0 / mean_under_hat(light, centre_nm, half_nm));
    ContinuationShape { below: relative(FIRST_NM, FIRST_NM - 300.0), above: relative(LAST_NM, STEP_NM) }
}

/// The mean about a wavelength with triangular weights, excluding the gas bands.
fn mean_under_hat(light: &Spectrum, centre_nm: f64, half_nm: f64) -> f64 {
    let in_gas = |nm: f64| GAS_NM.iter().any(|(low, high)| (*low..=*high).contains(&nm));
    let weight = |nm: f64| if in_gas(nm) { 0.0 } else { (1.0 - (nm - centre_nm).abs() / half_nm).max(0.0) };
    let (mut sum, mut total) = (0.0, 0.0);
    for (i, value) in (0..NODES).zip(light.nodes()) {
        sum += weight(node_nm(i)) * f64::from(*value);
        total += weight(node_nm(i));
    }
    sum / total
}

fn mix(nm: f64, shape: &ContinuationShape) -> BandWeights {
    if nm < FIRST_NM {
        return BandWeights { band: 0, weights: [f64::from(shape.below.at(nm as f32)), 0.0] };
    }
    if nm > LAST_NM {
        return BandWeights { band: BANDS - 2, weights: [0.0, f64::from(shape.above.at(nm as f32))] };
    }
    let (band, t) = band_below(nm);
    BandWeights { band, weights: [1.0 - t, t] }
}

/// The band at or below a wavelength, never the last, and the fraction towards the next, in [0, 1].
fn band_below(nm: f64) -> (usize, f64) {
    let x = ((nm - FIRST_NM) / STEP_NM).clamp(0.0, (BANDS - 1) as f64);
    let band = (x as usize).min(BANDS - 2);
    (band, x - band as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn out_of_range_is_reported() {
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

    #[test]
    fn tables_are_whole() {
        assert_eq!((SHAPES.len(), MEANS.len(), SUN.len(), LIMB.len()), (1080, 120, 1800, BANDS));
    }

    #[test]
    fn published_figures() {
        // Commonly stated illuminances for these moments: 759, 3.4, 8.3e-3 and 6.5e-4 lx; fits of such data are accurate to 0.03 in the logarithm.
        for (degrees, lux) in [(0.0, 759.0), (-6.0, 3.4), (-12.0, 8.3e-3), (-18.0, 6.5e-4)] {
            let off = maths::f64::log10(illuminance(degrees) / lux);
            assert!(off.abs() < 0.03, "{degrees}°: {}", illuminance(degrees));
        }
        assert_eq!(illuminance(-60.0), illuminance(-18.0));
    }

    #[test]
    fn fits_meet() {
        for degrees in [-5.0, -12.0, -18.0] {
            // Accuracy of the fits themselves.
            let step = maths::f64::log10(illuminance(degrees - 1e-9) / illuminance(degrees + 1e-9));
            assert!(step.abs() < 0.03, "{degrees}°: {step}");
        }
    }

    #[test]
    fn bands_are_exact_and_lines_lie_between() {
        for mix in [sky, sun] {
            assert_eq!(mix(320.0), BandWeights { band: 0, weights: [1.0, 0.0] });
            assert_eq!(mix(410.0), BandWeights { band: 2, weights: [0.75, 0.25] });
            assert_eq!(mix(720.0), BandWeights { band: 9, weights: [0.0, 1.0] });
        }
    }

    /// The band's mean, with its own weights and without the gases, equals the band: the only steps there are the gas bands.
    #[test]
    fn means_go_on_across_the_joins() {
        for mix in [sky, sun] {
            for (centre, half, pick) in [(320.0, 20.0, 0), (720.0, 40.0, 1)] {
                let shape = if pick == 0 { &SKY.below } else { &SKY.above };
                assert!((mean_under_hat(shape, centre, half) - 1.0).abs() < 1e-6);
                // Just outside the join and its gases the shape is near its mean. The light of 300 to 340 nm grows thirtyfold, so its centre is
                // within a quarter of its mean; the light at 735 nm loses 9 % to 15 nm.
                let outside: f64 = if pick == 0 { 319.0 } else { 737.0 };
                let value = mix(outside).weights[pick];
                assert!((value - 1.0).abs() < if pick == 0 { 0.25 } else { 0.09 }, "{outside} nm: {value}");
            }
        }
    }

    #[test]
    fn beyond_the_joins_the_shape_is_the_standards() {
        let solar = illuminant::solar();
        let sky_shape = |nm: f32| solar.global_tilt.at(nm) - solar.direct.at(nm);
        for (a, b, pick) in [(302.0f32, 315.5f32, 0), (760.0, 1050.0, 1), (730.0, 1100.0, 1)] {
            let ratio = |mix: fn(f64) -> BandWeights| mix(f64::from(a)).weights[pick] / mix(f64::from(b)).weights[pick];
            // Values and their difference are stored in single precision.
            assert!((ratio(sun) * f64::from(solar.direct.at(b) / solar.direct.at(a)) - 1.0).abs() < 1e-5);
            assert!((ratio(sky) * f64::from(sky_shape(b) / sky_shape(a)) - 1.0).abs() < 1e-4);
        }
        for nm in 300..=1100 {
            let positive = |mix: BandWeights| mix.weights.iter().all(|w| (0.0..2.0).contains(w));
            assert!(positive(sky(f64::from(nm))) && positive(sun(f64::from(nm))), "{nm} nm");
        }
    }
}
