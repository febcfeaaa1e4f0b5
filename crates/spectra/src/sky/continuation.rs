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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_met_exactly_and_lines_lie_between() {
        for mix in [sky, sun] {
            assert_eq!(mix(320.0), Mix { band: 0, weights: [1.0, 0.0] });
            assert_eq!(mix(410.0), Mix { band: 2, weights: [0.75, 0.25] });
            assert_eq!(mix(720.0), Mix { band: 9, weights: [0.0, 1.0] });
        }
    }

    /// The band's mean, by its own weights and without the gases, is the band: nothing steps there but what the gases
    /// take.
    #[test]
    fn means_go_on_across_the_joins() {
        for mix in [sky, sun] {
            for (centre, half, pick) in [(320.0, 20.0, 0), (720.0, 40.0, 1)] {
                let shape = if pick == 0 { &SKY.below } else { &SKY.above };
                assert!((mean_under_hat(shape, centre, half) - 1.0).abs() < 1e-6);
                // Just outside the join and its gases the shape is near its mean. The light of 300 to 340 nm grows
                // thirtyfold, so that its middle lies within a quarter of its mean; that of 735 nm loses 9 % to 15 nm.
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
            let ratio = |mix: fn(f64) -> Mix| mix(f64::from(a)).weights[pick] / mix(f64::from(b)).weights[pick];
            // Values and their difference are stored in single precision.
            assert!((ratio(sun) * f64::from(solar.direct.at(b) / solar.direct.at(a)) - 1.0).abs() < 1e-5);
            assert!((ratio(sky) * f64::from(sky_shape(b) / sky_shape(a)) - 1.0).abs() < 1e-4);
        }
        for nm in 300..=1100 {
            let positive = |mix: Mix| mix.weights.iter().all(|w| (0.0..2.0).contains(w));
            assert!(positive(sky(f64::from(nm))) && positive(sun(f64::from(nm))), "{nm} nm");
        }
    }
}
