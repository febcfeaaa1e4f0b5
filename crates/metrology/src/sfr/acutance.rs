//! Acutance: how sharp a picture looks from where it is viewed.
//!
//! After the camera phone image quality metrics (IEEE 1858; Baxter, Cao, Eliasson & Phillips 2012), whose contrast sensitivity of the eye follows
//! Johnson & Fairchild (2003):
//!
//! ```text
//! A = ∫ SFR(ν) CSF(ν) dν / ∫ CSF(ν) dν       numerator to half a cycle a pixel, denominator to ∞
//! CSF(ν) = a νᶜ exp(−b ν)/K                   a = 75, b = 0.2, c = 0.8, K = 34.05; ν in cycles a degree
//! ν = f p                                    f: cycles a pixel, p: pixels of the picture a degree at the eye
//! ```
//!
//! a and K cancel; ∫ νᶜ e^(−bν) dν = Γ(1.8)/0.2^1.8. A camera whose response is 1 up to half a cycle a pixel has the share of the CSF that such pixels
//! can show, 0.987 at 60 pixels a degree. Between the response's points it runs straight. Uncertainty: as if all points erred together, an upper bound.
//! Left out: the display's own response, and loss of quality in JND.

use super::SfrPoint;
use crate::Estimate;
use etendue_core::maths::f64::{exp, pow};

const B: f64 = 0.2;
const C: f64 = 0.8;
/// Γ(1.8).
const GAMMA: f64 = 0.931_383_770_980_243;
/// The last frequency that pixels can show.
const LAST: f64 = 0.5;
/// Midpoints between two points of the response.
const STEPS: usize = 16;

/// The acutance of a response in cycles a pixel that begins at 0, seen at so many pixels a degree; none where the response ends below
/// half a cycle a pixel.
#[must_use]
pub fn acutance(curve: &[SfrPoint], pixels_per_degree: f64) -> Option<Estimate> {
    let reaches = curve.last().is_some_and(|p| p.frequency >= LAST - 1e-9);
    let positive = pixels_per_degree > 0.0 && pixels_per_degree.is_finite();
    if !reaches || !positive {
        return None;
    }
    let whole = GAMMA / pow(B, 1.0 + C);
    let parts = curve.windows(2).filter(|pair| pair[0].frequency < LAST - 1e-9);
    let sums = parts.map(|pair| interval([pair[0], pair[1]], pixels_per_degree));
    let [value, u] = sums.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    Some(Estimate::new(value / whole, u / whole))
}

/// ∫ SFR CSF dν between two points, and the same of the uncertainty.
fn interval([a, b]: [SfrPoint; 2], pixels_per_degree: f64) -> [f64; 2] {
    let width = (b.frequency.min(LAST) - a.frequency) / STEPS as f64;
    let term = |i: usize| {
        let f = a.frequency + (i as f64 + 0.5) * width;
        let t = (f - a.frequency) / (b.frequency - a.frequency);
        let mix = |x: f64, y: f64| (1.0 - t) * x + t * y;
        let nu = f * pixels_per_degree;
        let weight = pow(nu, C) * exp(-B * nu) * width * pixels_per_degree;
        let (p, q) = (a.response, b.response);
        [mix(p.value, q.value), mix(p.standard_uncertainty, q.standard_uncertainty)].map(|v| v * weight)
    };
    (0..STEPS).map(term).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(response: impl Fn(f64) -> f64) -> Vec<SfrPoint> {
        let point = |i: i32| {
            let frequency = 0.01 * f64::from(i);
            SfrPoint { frequency, response: Estimate::new(response(frequency), 0.01) }
        };
        (0..=100).map(point).collect()
    }

    #[test]
    fn acutance_is_the_share_of_what_the_eye_sees() {
        // exp(−k f) only steepens the CSF's own fall: (b/(b + k/p))^1.8 of the whole, but for what lies beyond 0.5 cycles a pixel, which
        // 120 pixels a degree put at 60 cycles a degree, exp(−12) of the whole.
        let found = acutance(&curve(|f| exp(-12.0 * f)), 120.0).expect("it reaches 0.5");
        let expected = pow(0.2 / (0.2 + 0.1), 1.8);
        // Chords of it over 0.01 lie (12 · 0.01)²/12 of it too high: 5.8e-4.
        assert!((found.value - expected).abs() < 7e-4, "{found:?} {expected}");
        // The whole CSF errs by a hundredth.
        assert!((found.standard_uncertainty - 0.01).abs() < 1e-4, "{found:?}");
        // Incomplete gamma: P(1.8, 0.2 · 30) = 0.987395 (its series).
        let sharp = acutance(&curve(|_| 1.0), 60.0).expect("it reaches 0.5");
        assert!((sharp.value - 0.987_395).abs() < 1e-4, "{sharp:?}");
        assert_eq!(acutance(&curve(|_| 1.0)[..40], 60.0), None);
        assert_eq!(acutance(&curve(|_| 1.0), 0.0), None);
    }
}
