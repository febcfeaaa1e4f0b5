//! Between the bands, and beyond them to 300 and 1 100 nm.
//!
//! Between 320 and 720 nm radiance is linear between bands. Beyond, it has the shape of ASTM G-173: the Sun that of
//! direct light, the sky that of global less direct light, at the scale
//! L(λ) = L(band) · S(λ)/S̄(band), with S̄ the mean of the shape S over the outermost band:
//!
//! - **320 nm**: under the hat 1 − |λ − 320 nm|/20 nm (300–340 nm: the shape has nothing below);
//! - **720 nm**: under the hat 1 − |λ − 720 nm|/40 nm (680–760 nm, the band's own weight in the interpolation), leaving
//!   out 686–695 nm and 714–735 nm, where oxygen and water absorb: the tables of the model know neither.
//!
//! So band means go on without a step while the shape's own absorption lines remain: just above 720 nm lies the rest of
//! a water band, which the model below lacks.
//!
//! **Left out.** The shape is that of one air mass (1.5), one turbidity and one albedo; a low Sun is redder beyond
//! 720 nm. The global light of the standard falls on a plane tilted 37° and holds light from the ground.
//! Source: ASTM G-173-03 (2012).

use super::{BANDS, FIRST_NM, LAST_NM, STEP_NM};
use crate::spectrum::{NODES, node_nm};
use crate::{Spectrum, illuminant};
use std::sync::LazyLock;

/// Wavelengths at which oxygen and water absorb, left out of means, nm.
const GAS_NM: [(f64, f64); 2] = [(686.0, 695.0), (714.0, 735.0)];

/// How much of two neighbouring bands makes the radiance at a wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix {
    /// The lower band.
    pub band: usize,
    /// Weights of that band and the next.
    pub weights: [f64; 2],
}

impl Mix {
    /// The mix of one value a band.
    #[must_use]
    pub fn of(&self, values: &[f64; BANDS]) -> f64 {
        self.weights[0] * values[self.band] + self.weights[1] * values[self.band + 1]
    }
}

/// The mix of bands at a wavelength (nm, 300 to 1 100) of the sky's light.
#[must_use]
pub fn sky(nm: f64) -> Mix {
    mix(nm, &SKY)
}

/// The mix of bands at a wavelength (nm, 300 to 1 100) of the Sun's light.
#[must_use]
pub fn sun(nm: f64) -> Mix {
    mix(nm, &SUN)
}

/// The sky's spectrum from one value a band.
#[must_use]
pub fn sky_spectrum(values: &[f64; BANDS]) -> Spectrum {
    Spectrum::from_fn(|nm| sky(nm).of(values))
}

/// The Sun's spectrum from one value a band.
#[must_use]
pub fn sun_spectrum(values: &[f64; BANDS]) -> Spectrum {
    Spectrum::from_fn(|nm| sun(nm).of(values))
}

/// The shape beyond both ends, relative to the band there.
struct Shape {
    below: Spectrum,
    above: Spectrum,
}

static SUN: LazyLock<Shape> = LazyLock::new(|| shape(&illuminant::solar().direct));

static SKY: LazyLock<Shape> = LazyLock::new(|| {
    let solar = illuminant::solar();
    shape(&Spectrum::from_fn(|nm| f64::from(solar.global_tilt.at(nm as f32) - solar.direct.at(nm as f32))))
});

fn shape(light: &Spectrum) -> Shape {
    let relative = |centre_nm, half_nm| light.scaled(1.0 / mean_under_hat(light, centre_nm, half_nm));
    Shape { below: relative(FIRST_NM, FIRST_NM - 300.0), above: relative(LAST_NM, STEP_NM) }
}

/// The mean about a wavelength with weights that fall linearly to zero, without the gases' bands.
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

fn mix(nm: f64, shape: &Shape) -> Mix {
    if nm < FIRST_NM {
        return Mix { band: 0, weights: [f64::from(shape.below.at(nm as f32)), 0.0] };
    }
    if nm > LAST_NM {
        return Mix { band: BANDS - 2, weights: [0.0, f64::from(shape.above.at(nm as f32))] };
    }
    let (band, t) = band_below(nm);
    Mix { band, weights: [1.0 - t, t] }
}

/// The band at or below a wavelength, never the last, and how far on the wavelength lies, in [0, 1].
pub(super) fn band_below(nm: f64) -> (usize, f64) {
    let x = ((nm - FIRST_NM) / STEP_NM).clamp(0.0, (BANDS - 1) as f64);
    let band = (x as usize).min(BANDS - 2);
    (band, x - band as f64)
}
