//! A spatial frequency response by points: mean of several, and the frequency at which one falls to a level.
//!
//! Acutance: perceived sharpness of an image under a viewing condition.
//!
//! After the camera phone image quality metrics (IEEE 1858; Baxter, Cao, Eliasson & Phillips 2012), whose contrast sensitivity of
//! the eye follows Johnson & Fairchild (2003):
//!
//! ```text
//! A = ∫ SFR(ν) CSF(ν) dν / ∫ CSF(ν) dν       numerator to half a cycle per pixel, denominator to ∞
//! CSF(ν) = a νᶜ exp(−b ν)/K                   a = 75, b = 0.2, c = 0.8, K = 34.05; ν in cycles per degree
//! ν = f p                                    f: cycles per pixel, p: pixels of the image per degree at the eye
//! ```
//!
//! a and K cancel; ∫ νᶜ e^(−bν) dν = Γ(1.8)/0.2^1.8. A camera whose response is 1 up to half a cycle per pixel has the fraction of
//! the CSF that such pixels can show, 0.987 at 60 pixels per degree. The response is interpolated linearly between its points.
//! Uncertainty: as if the errors of all points were fully correlated, an upper bound. Limitations: no response of the display, no
//! loss of quality in JND.

use etendue_core::maths::f64::{exp, pow};

use super::edge::Orientation;
use crate::Estimate;

/// A point of the response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SfrPoint {
    /// Cycles per pixel along the edge's normal.
    pub frequency: f64,
    /// Response, 1 at frequency 0.
    pub response: Estimate,
}

/// The mean of responses at the same frequencies.
#[must_use]
pub fn mean_curve(curves: &[&[SfrPoint]]) -> Vec<SfrPoint> {
    let count = curves.len() as f64;
    let at = |i: usize| {
        let points = || curves.iter().map(|curve| curve[i].response);
        let squares: f64 = points().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum();
        let response = Estimate::new(points().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count);
        SfrPoint { frequency: curves[0][i].frequency, response }
    };
    let min_length = curves.iter().map(|curve| curve.len()).min().unwrap_or(0);
    (0..min_length).map(at).collect()
}

/// Frequency at which the curve falls to a level: midway between the crossings of the curve less its standard uncertainty and of
/// the curve plus it, so that a noisy curve is not evaluated at its first dip. The uncertainty is half of that interval, or the
/// uncertainty over the slope of a line through the points near the crossing if that is more (as neighbours share their noise, a
/// pair's slope would be mostly noise).
#[must_use]
pub fn crossing(curve: &[SfrPoint], level: f64) -> Option<Estimate> {
    const ABOUT: f64 = 0.05;
    let first = |sigmas: f64| {
        let value = |p: &SfrPoint| p.response.value + sigmas * p.response.standard_uncertainty;
        let pair = curve.windows(2).find(|pair| value(&pair[0]) > level && value(&pair[1]) <= level)?;
        let fraction = (value(&pair[0]) - level) / (value(&pair[0]) - value(&pair[1]));
        Some(pair[0].frequency + fraction * (pair[1].frequency - pair[0].frequency))
    };
    let plain = first(0.0)?;
    let (low, high) = (first(-1.0).unwrap_or(plain), first(1.0).unwrap_or(plain));
    let at = 0.5 * (low + high);
    let near: Vec<&SfrPoint> = curve.iter().filter(|p| (p.frequency - at).abs() <= ABOUT).collect();
    let mean = |f: fn(&SfrPoint) -> f64| near.iter().map(|p| f(p)).sum::<f64>() / near.len() as f64;
    let (x, y) = (mean(|p| p.frequency), mean(|p| p.response.value));
    let products = near.iter().map(|p| (p.frequency - x) * (p.response.value - y)).sum::<f64>();
    let slope = products / near.iter().map(|p| (p.frequency - x) * (p.frequency - x)).sum::<f64>();
    let u = near.iter().map(|p| p.response.standard_uncertainty).fold(0.0, f64::max);
    Some(Estimate::new(at, (u / slope.abs()).max(0.5 * (high - low))))
}

/// Response of an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Sfr {
    /// Angle between the edge and the nearest of rows and columns, degrees, 0 to 45.
    pub angle_deg: f64,
    /// The nearest of rows and columns.
    pub orientation: Orientation,
    /// Levels of the dark and the bright side, in the image's readings.
    pub levels: [f64; 2],
    /// Standard deviation of the residuals, in the image's readings.
    pub noise: f64,
    /// Step of the profile's splines, pixels.
    pub step_px: f64,
    /// The response at frequencies from 0 on.
    pub curve: Vec<SfrPoint>,
    /// Frequency at which the response first falls to a half, cycles per pixel; `None` if it does not within the curve.
    pub mtf50: Option<Estimate>,
    /// Frequency at which the response first falls to a tenth.
    pub mtf10: Option<Estimate>,
    /// Maximum change of the response, beyond its noise, if shading is removed by surfaces of one degree more.
    pub shading: f64,
    /// The edge profile: (distance, px; reading), at equal steps.
    pub profile: Vec<(f64, f64)>,
}

impl Sfr {
    /// Includes the change by shading surfaces of one degree more. If that exceeds the noise, the sides are less uniform than
    /// assumed, and the difference is half the width of a rectangular distribution (GUM 4.3.7).
    pub(super) fn with_choice_of_shading(self, other: &Self) -> Self {
        let differ = |(a, b): (&SfrPoint, &SfrPoint)| {
            let by = (a.response.value - b.response.value).abs();
            if by > 2.0 * a.response.standard_uncertainty { by } else { 0.0 }
        };
        let shading = self.curve.iter().zip(&other.curve).map(differ).fold(0.0, f64::max);
        let point = |(a, b): (&SfrPoint, &SfrPoint)| SfrPoint { response: widened(a.response, b.response), ..*a };
        let crossed = |a: Option<Estimate>, b: Option<Estimate>| a.map(|a| b.map_or(a, |b| widened(a, b)));
        Self {
            curve: self.curve.iter().zip(&other.curve).map(point).collect(),
            mtf50: crossed(self.mtf50, other.mtf50),
            mtf10: crossed(self.mtf10, other.mtf10),
            shading,
            ..self
        }
    }

    /// Converts for readings that are `pitch_px` pixels apart: lengths in pixels, frequencies in cycles per pixel.
    #[must_use]
    pub fn sampled_every(self, pitch_px: f64) -> Self {
        let slower = |e: Estimate| e.scaled(1.0 / pitch_px);
        let point = |p: SfrPoint| SfrPoint { frequency: p.frequency / pitch_px, ..p };
        Self {
            step_px: self.step_px * pitch_px,
            mtf50: self.mtf50.map(slower),
            mtf10: self.mtf10.map(slower),
            curve: self.curve.into_iter().map(point).collect(),
            profile: self.profile.into_iter().map(|(d, reading)| (d * pitch_px, reading)).collect(),
            ..self
        }
    }
}

/// u² = u_a² + max((a − b)² − u_a², 0)/3: nothing is added for a difference within its own uncertainty.
pub(super) fn widened(a: Estimate, b: Estimate) -> Estimate {
    let own = a.standard_uncertainty * a.standard_uncertainty;
    let excess = ((a.value - b.value) * (a.value - b.value) - own).max(0.0);
    Estimate::new(a.value, (own + excess / 3.0).sqrt())
}

const B: f64 = 0.2;
const C: f64 = 0.8;
/// Γ(1.8).
const GAMMA: f64 = 0.931_383_770_980_243;
/// Nyquist frequency, cycles per pixel.
const LAST: f64 = 0.5;
/// Midpoints between two points of the response, for integration.
const STEPS: usize = 16;

/// The acutance of a response in cycles per pixel that begins at 0, seen at this many pixels per degree; `None` if the response
/// ends below half a cycle per pixel.
#[must_use]
pub fn acutance(curve: &[SfrPoint], pixels_per_degree: f64) -> Option<Estimate> {
    let reaches = curve.last().is_some_and(|p| p.frequency >= LAST - 1e-9);
    let positive = pixels_per_degree > 0.0 && pixels_per_degree.is_finite();
    if !reaches || !positive {
        return None;
    }
    let normalisation = GAMMA / pow(B, 1.0 + C);
    let parts = curve.windows(2).filter(|pair| pair[0].frequency < LAST - 1e-9);
    let sums = parts.map(|pair| interval([pair[0], pair[1]], pixels_per_degree));
    let [value, u] = sums.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    Some(Estimate::new(value / normalisation, u / normalisation))
}

/// ∫ SFR CSF dν between two points, and the same for the uncertainty.
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
    fn acutance_is_the_fraction_of_visible_contrast() {
        // exp(−k f) only steepens the CSF's own fall: (b/(b + k/p))^1.8 of the whole, except for the part above 0.5 cycles per pixel,
        // which is at 60 cycles per degree for 120 pixels per degree, exp(−12) of the whole.
        let result = acutance(&curve(|f| exp(-12.0 * f)), 120.0).expect("it reaches 0.5");
        let expected = pow(0.2 / (0.2 + 0.1), 1.8);
        // Its chords over 0.01 are too high by (12 · 0.01)²/12 of it: 5.8e-4.
        assert!((result.value - expected).abs() < 7e-4, "{result:?} {expected}");
        // An error of a hundredth of the whole CSF.
        assert!((result.standard_uncertainty - 0.01).abs() < 1e-4, "{result:?}");
        // Incomplete gamma: P(1.8, 0.2 · 30) = 0.987395 (its series).
        let sharp = acutance(&curve(|_| 1.0), 60.0).expect("it reaches 0.5");
        assert!((sharp.value - 0.987_395).abs() < 1e-4, "{sharp:?}");
        assert_eq!(acutance(&curve(|_| 1.0)[..40], 60.0), None);
        assert_eq!(acutance(&curve(|_| 1.0), 0.0), None);
    }
}
