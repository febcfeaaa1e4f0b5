//! What sampling by square pixels does to the centroid of a disc.
//!
//! A pixel takes in its whole square, and counts as if all of it came from its middle. Of a disc (an ellipse of half width a along a
//! coordinate, centre c) blurred by a Gaussian of standard deviation s before the pixels, the sum over pixels is off by the harmonics of the raster
//! (Poisson's sum; for the pixel's own sinc only those along the coordinate itself are left):
//!
//! ```text
//! centroid − c = Σₖ 2 J₁(2πka)/(2πka) · exp(−2π²k²s²) · sin(2πkc)/(πk)        k = 1, 2, …; c in raster coordinates
//! ```
//!
//! 0.006 px at most for a sharp disc of 3 px radius, 0.001 px for 10 px: little, but the same for all dots of a column, and where steps are nearly
//! whole pixels it drifts slowly over the field and passes for distortion.
//!
//! s is told by the rim itself: with w the share of a pixel that the disc covers, Σ w (1 − w) over the rim's length, Q, is 1/6 px for a
//! sharp edge and grows as Q² = 1/36 + s²/π, in the mean over all dots. A blur of 0.4 px leaves 4 % of the first harmonic.
//!
//! Premise: pixels without gaps between their apertures, and a blur like a Gaussian where it is less than half a pixel.

use core::f64::consts::{FRAC_PI_4, PI, TAU};
use etendue_core::maths::f64::{cos, exp, sin_cos};
use glam::DVec2;

/// Harmonics that are taken off.
const HARMONICS: u32 = 3;
/// Least half width, px.
const MIN_PX: f64 = 1.6;
/// Q of a sharp edge, px.
const SHARP_PX: f64 = 1.0 / 6.0;

/// An ellipse as its rim shows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    /// Half the width and half the height of the upright rectangle around it, px.
    pub(super) half: DVec2,
    /// Q of this one, px: off by a tenth by how the rim lies among the pixels.
    pub(super) softness_px: f64,
}

/// The variance of the blur before the pixels, s², of rims that lie anyhow among them: by their mean Q.
pub(super) fn blur_px2(rims: impl Iterator<Item = Rim>) -> f64 {
    let (sum, count) = rims.fold((0.0, 0.0), |(sum, count), rim| (sum + rim.softness_px, count + 1.0));
    let softness: f64 = if count > 0.0 { sum / count } else { SHARP_PX };
    PI * (softness * softness - SHARP_PX * SHARP_PX).max(0.0)
}

/// The centre of an ellipse of a centroid.
pub(super) fn centre(centroid: DVec2, rim: &Rim, blur_px2: f64) -> DVec2 {
    const ROUNDS: usize = 3;
    (0..ROUNDS).fold(centroid, |at, _| centroid - shift(at, rim.half, blur_px2))
}

fn shift(centre: DVec2, half: DVec2, blur_px2: f64) -> DVec2 {
    let along = |a: f64, c: f64| -> f64 {
        let harmonic = |k: f64| {
            let blur = exp(-0.5 * TAU * TAU * k * k * blur_px2);
            disc(TAU * k * a) * blur * sin_cos(TAU * k * c).0 / (PI * k)
        };
        // A shape that noise has spoiled, or too small for the expansion, tells nothing.
        let told = a.is_finite() && a >= MIN_PX;
        if told { (1..=HARMONICS).map(|k| harmonic(f64::from(k))).sum() } else { 0.0 }
    };
    DVec2::new(along(half.x, centre.x), along(half.y, centre.y))
}

/// 2 J₁(z)/z by Hankel's expansion (Abramowitz & Stegun 9.2.5): to 1e-4 of its size from z = 10 on, discs of 1.6 px.
fn disc(z: f64) -> f64 {
    let (angle, inverse) = (z - 3.0 * FRAC_PI_4, 1.0 / z);
    let (even, odd) = (1.0 + 15.0 / 128.0 * inverse * inverse, 0.375 * inverse);
    let (sin, _) = sin_cos(angle);
    2.0 * inverse * (2.0 * inverse / PI).sqrt() * (even * cos(angle) - odd * sin)
}

/// The rim's length of an ellipse of semi-axes (Ramanujan 1914).
pub(super) fn length(a: f64, b: f64) -> f64 {
    PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_of_a_disc_is_bessel_s() {
        // J₁(12) = −0.2234471045, J₁(40) = 0.1260383181 (Abramowitz & Stegun, table 9.1 and its recurrence).
        assert!((disc(12.0) + 0.223_447_104_5 / 6.0).abs() < 1e-5, "{}", disc(12.0));
        assert!((disc(40.0) - 0.126_038_318_1 / 20.0).abs() < 1e-6, "{}", disc(40.0));
        assert!((length(2.0, 2.0) - 2.0 * TAU).abs() < 1e-12);
    }
}
