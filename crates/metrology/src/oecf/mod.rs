//! Opto-electronic conversion function: readings against exposure.
//!
//! ISO 14524:2009 (focal-plane OECF) from images of one surface at many exposures, or from steps of known luminance in one image;
//! figure 13 of Gruyer, Grapinet & De Souza uses fifteen exposures of a back-lit panel. Results:
//!
//! ```text
//! points      mean reading against exposure, with its standard uncertainty ([`patch_statistics`](crate::patch_statistics)) and
//! the rounding error
//!             ([`rounding_variance`])
//! curve       monotone cubic through the points (Fritsch & Carlson 1980), and its slope (incremental gain)
//! linearity   straight line y = a + b H over 5…95 % of the range, weights 1/(y − black)² (EMVA 1288): largest relative deviation
//! range       exposure at saturation over that of SNR 1, from the noise of the points (ISO 15739, 6.3: signal over temporal
//! noise
//!             referred to the exposure: H (dy/dH)/σ)
//! ```
//!
//! Saturation is the first point that rises by less than a tenth of the slope of the straight part, or with more than a
//! thousandth of its pixels at full scale, if that is known.
//!
//! Refused: fewer than three exposures, exposures that are not positive or are equal, decreasing readings.
//!
//! Mean reading of noisy light through a curve:
//!
//! A pixel of light L + σ z, z normal, reads y(L + σ z), and the mean of many is not y(L): a bent curve, such as the end of a
//! tone curve or a saturation, shifts it. σ follows from the measured standard deviation s of the readings,
//!
//! ```text
//! ∫ y(L + σ z)² φ(z) dz − (∫ y(L + σ z) φ(z) dz)² = s²        mean = ∫ y(L + σ z) φ(z) dz
//! ```
//!
//! by 161 steps of the trapezoidal rule over |z| ≤ 5 (its error for smooth curves is below rounding; a knee of slopes m₁ and m₂
//! inside leaves (m₁ − m₂) σ h²/8 at most, h 1/16: 5·10⁻⁴ of the bend over σ).

pub mod response;
#[cfg(test)]
mod tests;

use core::f64::consts::PI;

use etendue_core::maths::f64::{exp, ln};

use crate::patch_statistics::{patch_statistics, saturated_percent};
use crate::{Estimate, Image};

/// A surface at one exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExposurePoint {
    /// Exposure or luminance, any unit.
    pub exposure: f64,
    /// Mean reading.
    pub reading: Estimate,
    /// Standard deviation of a single pixel's reading over time (or within the surface), if known.
    pub noise: Option<f64>,
    /// True if pixels are saturated, which lowers mean and noise.
    pub clipped: bool,
}

impl ExposurePoint {
    /// Mean and scatter of a uniform surface with equal errors in blocks of `shared_px` × `shared_px` pixels (1: none);
    /// `full_scale` is the reading of a saturated pixel.
    #[must_use]
    pub fn from_surface(exposure: f64, surface: &Image, full_scale: Option<f64>, shared_px: usize) -> Self {
        let patch = patch_statistics(surface, shared_px);
        let integers = surface.samples().iter().all(|s| s.fract() == 0.0);
        let rounding = if integers { rounding_variance(patch.variance.value) } else { 0.0 };
        let own = patch.mean.standard_uncertainty;
        Self {
            exposure,
            reading: Estimate::new(patch.mean.value, (own * own + rounding).sqrt()),
            noise: Some(patch.variance.value.sqrt()),
            clipped: saturated_percent([surface], full_scale).is_some(),
        }
    }
}

/// The variance that rounding to integers leaves in a mean of many readings, from the variance of a single one. Noise of about
/// one step averages rounding out; without noise 1/12 remains. With σ the noise before rounding, the mean of y + rounding error
/// over the phase of y varies by Σ_k exp(−4π² k² σ²)/(2π² k²) (Widrow & Kollár 2008).
#[must_use]
pub fn rounding_variance(variance: f64) -> f64 {
    const TERMS: i32 = 200;
    let before = (variance - 1.0 / 12.0).max(0.0);
    let term = |k: f64| exp(-4.0 * PI * PI * k * k * before) / (2.0 * PI * PI * k * k);
    (1..=TERMS).map(|k| term(f64::from(k))).sum()
}

/// A tone curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Oecf {
    points: Vec<ExposurePoint>,
    slopes: Vec<f64>,
    saturation: usize,
}

/// A straight line through the points below saturation.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearity {
    /// Reading at zero exposure.
    pub offset: f64,
    /// Reading per unit of exposure.
    pub slope: f64,
    /// Relative deviation of each point from the line.
    pub deviations: Vec<f64>,
    /// The largest magnitude among the fitted points.
    pub largest: f64,
}

/// Reason why there is no tone curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OecfError {
    /// Too few points.
    #[error("a tone curve needs at least three exposures, not {0}: give more images or steps")]
    TooFew(usize),
    /// An exposure is not a positive number.
    #[error("exposures must be positive numbers, not {0}")]
    Exposure(f64),
    /// Two points have equal exposures.
    #[error("two points have the exposure {0}: give each exposure once")]
    Twice(f64),
    /// Higher exposure, lower reading.
    #[error(
        "the reading falls from {from:.2} to {to:.2} between the exposures {low} and {high}: check the order of the exposures"
    )]
    Falls {
        /// The lower exposure.
        low: f64,
        /// The higher one.
        high: f64,
        /// Reading at the lower one.
        from: f64,
        /// Reading at the higher one.
        to: f64,
    },
    /// Readings do not change.
    #[error("the readings do not change with the exposure: check that the images differ and are not saturated")]
    Flat,
    /// The lowest exposure is saturated.
    #[error("the shortest exposure, {0}, is saturated: expose less")]
    Saturated(f64),
}

impl Oecf {
    /// Creates the curve from points in any order.
    ///
    /// # Errors
    /// If there are too few, exposures are unusable, or readings decrease by more than four standard uncertainties.
    pub fn new(mut points: Vec<ExposurePoint>) -> Result<Self, OecfError> {
        if points.len() < 3 {
            return Err(OecfError::TooFew(points.len()));
        }
        if let Some(point) = points.iter().find(|p| !(p.exposure > 0.0 && p.exposure.is_finite())) {
            return Err(OecfError::Exposure(point.exposure));
        }
        points.sort_by(|a, b| a.exposure.total_cmp(&b.exposure));
        for pair in points.windows(2) {
            is_rising(pair[0], pair[1])?;
        }
        let (first, last) = (points[0].reading.value, points[points.len() - 1].reading.value);
        if last <= first {
            return Err(OecfError::Flat);
        }
        if points[0].clipped {
            return Err(OecfError::Saturated(points[0].exposure));
        }
        let slopes = monotone_slopes(&points);
        let clipped = points.iter().position(|p| p.clipped).unwrap_or(points.len());
        let saturation = saturation(&points).min(clipped);
        Ok(Self { points, slopes, saturation })
    }

    /// The points, lowest exposure first.
    #[must_use]
    pub fn points(&self) -> &[ExposurePoint] {
        &self.points
    }

    /// Index of the first saturated point; the number of points if none is.
    #[must_use]
    pub fn saturation(&self) -> usize {
        self.saturation
    }

    /// The reading at an exposure within the range; that of the nearest end outside it.
    #[must_use]
    pub fn reading(&self, exposure: f64) -> f64 {
        let (k, t, width) = self.segment_at(exposure);
        let (a, b) = (self.points[k].reading.value, self.points[k + 1].reading.value);
        let (s, square) = (1.0 - t, t * t);
        let hermite = s * s * (1.0 + 2.0 * t) * a + square * (1.0 + 2.0 * s) * b;
        hermite + width * (s * s * t * self.slopes[k] - square * s * self.slopes[k + 1])
    }

    /// The curve's slope at an exposure: the incremental gain.
    #[must_use]
    pub fn gain(&self, exposure: f64) -> f64 {
        let (k, t, width) = self.segment_at(exposure);
        let rise = self.points[k + 1].reading.value - self.points[k].reading.value;
        let (m, n) = (self.slopes[k], self.slopes[k + 1]);
        6.0 * t * (1.0 - t) * rise / width + (1.0 - t) * (1.0 - 3.0 * t) * m + t * (3.0 * t - 2.0) * n
    }

    /// The interval of an exposure, the position in it, and its width.
    fn segment_at(&self, exposure: f64) -> (usize, f64, f64) {
        let above = self.points.partition_point(|p| p.exposure <= exposure);
        let k = above.clamp(1, self.points.len() - 1) - 1;
        let width = self.points[k + 1].exposure - self.points[k].exposure;
        (k, ((exposure - self.points[k].exposure) / width).clamp(0.0, 1.0), width)
    }

    /// The straight line over the points of 5 to 95 % of the range above `black`, below saturation; `None` for fewer than three.
    #[must_use]
    pub fn linearity(&self, black: f64) -> Option<Linearity> {
        let top = self.points[self.saturation.min(self.points.len()) - 1].reading.value - black;
        let within = |p: &&ExposurePoint| (0.05 * top..=0.95 * top).contains(&(p.reading.value - black));
        let used: Vec<&ExposurePoint> = self.points[..self.saturation].iter().filter(within).collect();
        if used.len() < 3 {
            return None;
        }
        let weight = |p: &ExposurePoint| 1.0 / ((p.reading.value - black) * (p.reading.value - black));
        let sum = |f: &dyn Fn(&ExposurePoint) -> f64| used.iter().map(|p| weight(p) * f(p)).sum::<f64>();
        let (w, x, y) = (sum(&|_| 1.0), sum(&|p| p.exposure), sum(&|p| p.reading.value));
        let (xx, xy) = (sum(&|p| p.exposure * p.exposure), sum(&|p| p.exposure * p.reading.value));
        let slope = (w * xy - x * y) / (w * xx - x * x);
        let offset = (y - slope * x) / w;
        let deviation = |p: &ExposurePoint| (p.reading.value - offset - slope * p.exposure) / (slope * p.exposure);
        let largest = used.iter().map(|p| deviation(p).abs()).fold(0.0, f64::max);
        Some(Linearity { offset, slope, deviations: self.points.iter().map(deviation).collect(), largest })
    }

    /// Exposure at saturation (or the highest) over that at which the signal equals the noise. `None` if the noise is unknown. If
    /// the signal exceeds the noise even at the lowest exposure, the noise of the lowest point is extrapolated.
    #[must_use]
    pub fn dynamic_range(&self) -> Option<f64> {
        let snr = |p: &ExposurePoint| Some(p.exposure * self.gain(p.exposure) / p.noise.filter(|n| *n > 0.0)?);
        let ratios: Vec<f64> = self.points.iter().map(snr).map_while(|r| r).collect();
        let top = self.points[self.saturation.clamp(1, self.points.len()) - 1].exposure;
        let first = ratios.first()?;
        let min_light = if *first >= 1.0 {
            // Below the first point noise and gain are constant: SNR falls in proportion.
            self.points[0].exposure / first
        } else {
            let k = ratios.windows(2).position(|pair| pair[0] < 1.0 && pair[1] >= 1.0)?;
            let (a, b) = (ln(ratios[k]), ln(ratios[k + 1]));
            let (low, high) = (ln(self.points[k].exposure), ln(self.points[k + 1].exposure));
            exp(low + (high - low) * -a / (b - a))
        };
        Some(top / min_light)
    }
}

fn is_rising(a: ExposurePoint, b: ExposurePoint) -> Result<(), OecfError> {
    if a.exposure == b.exposure {
        return Err(OecfError::Twice(a.exposure));
    }
    let (from, to) = (a.reading.value, b.reading.value);
    let u = a.reading.standard_uncertainty.max(b.reading.standard_uncertainty);
    // Saturated means vary by less than a thousandth.
    if to < from - 4.0 * u - 1e-3 * from.abs() {
        return Err(OecfError::Falls { low: a.exposure, high: b.exposure, from, to });
    }
    Ok(())
}

/// Slopes of Fritsch and Carlson: harmonic means of the secants, 0 at extrema and on plateaus.
fn monotone_slopes(points: &[ExposurePoint]) -> Vec<f64> {
    let secant = |pair: &[ExposurePoint]| {
        (pair[1].reading.value - pair[0].reading.value) / (pair[1].exposure - pair[0].exposure)
    };
    let secants: Vec<f64> = points.windows(2).map(secant).collect();
    let width = |k: usize| points[k + 1].exposure - points[k].exposure;
    let inner = |k: usize| {
        let (a, b) = (secants[k - 1], secants[k]);
        if a * b <= 0.0 {
            return 0.0;
        }
        let (w, v) = (2.0 * width(k) + width(k - 1), width(k) + 2.0 * width(k - 1));
        (w + v) / (w / a + v / b)
    };
    // Three-point slopes at the ends, limited to keep the curve monotone.
    let end = |near: usize, far: usize| {
        let (a, b) = (width(near), width(far));
        let slope = ((2.0 * a + b) * secants[near] - a * secants[far]) / (a + b);
        if slope * secants[near] <= 0.0 {
            0.0
        } else {
            slope.clamp(-3.0 * secants[near].abs(), 3.0 * secants[near].abs())
        }
    };
    let last = points.len() - 1;
    (0..=last)
        .map(|k| match k {
            0 => end(0, 1),
            k if k == last => end(last - 1, last - 2),
            k => inner(k),
        })
        .collect()
}

/// The first point of the plateau: its rise is below a tenth of the median secant before it.
fn saturation(points: &[ExposurePoint]) -> usize {
    let top = points[points.len() - 1].reading.value;
    let range = top - points[0].reading.value;
    let is_saturated = |k: &usize| {
        let rest = top - points[*k].reading.value;
        let fraction = (points[points.len() - 1].exposure - points[*k].exposure) / points[points.len() - 1].exposure;
        rest <= 0.1 * range * fraction && rest <= 0.01 * range
    };
    (1..points.len() - 1).find(is_saturated).unwrap_or(points.len())
}

/// The mean reading of light whose readings have the standard deviation `noise`.
pub fn noisy_mean(curve: impl Fn(f64) -> f64, light: f64, noise: f64) -> f64 {
    let moments_with = |sigma: f64| moments(&curve, light, sigma);
    if noise <= 0.0 || noise.is_nan() {
        return curve(light);
    }
    // Increase σ until the readings scatter enough; never if the curve is flat.
    let mut high = 1e-6 * light.abs().max(1e-6);
    while moments_with(high).1 < noise {
        high *= 2.0;
        if high > 1e6 * light.abs().max(1e-6) {
            return curve(light);
        }
    }
    let mut low = 0.0;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if moments_with(middle).1 < noise { low = middle } else { high = middle }
    }
    moments_with(0.5 * (low + high)).0
}

/// Mean and standard deviation of the readings.
fn moments(curve: &impl Fn(f64) -> f64, light: f64, sigma: f64) -> (f64, f64) {
    let (mut total, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for i in -80..=80 {
        let z = f64::from(i) / 16.0;
        let (weight, y) = (exp(-0.5 * z * z), curve(light + sigma * z));
        total += weight;
        sum += weight * y;
        squares += weight * y * y;
    }
    let mean = sum / total;
    (mean, (squares / total - mean * mean).max(0.0).sqrt())
}
