//! Response of a camera from differently exposed images of one scene, with relatively known exposures.
//!
//! Mitsunaga & Nayar (1999): the light of a pixel is a polynomial of its reading, so that images q and q + 1 of exposure ratio R
//! agree:
//!
//! ```text
//! f(M) = Σ c_n Mⁿ, f(1) = 1        minimise Σ (f(M_q) − R f(M_(q+1)))²/σ²        M: reading over full scale
//! ```
//!
//! Each pair's variance follows from that of the readings, f'(M)² σ_M², by reweighting. The contribution of the readings' noise
//! to the squares of the normal equations is subtracted (errors in variables, Fuller 1987), with σ_M² from the disagreement of
//! the pairs. With `refine` the ratios are estimated too, alternating with the coefficients, from approximate values (aperture
//! rings, shutters). The response is then determined only up to a power, as the authors show, and only noise or curvature fixes
//! it: known exposures are preferable.
//!
//! The degree is the lowest, up to `degree`, that the next one does not improve by more than two standard deviations. Refused:
//! fewer than two images, images of equal exposure, too few usable pixels.

use super::OecfError;
use crate::linear::{Matrix, Normal};
use crate::{Estimate, Image};

/// A response: light relative to its maximum, as a polynomial of the reading over full scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// c₀ … c_N.
    pub coefficients: Vec<f64>,
    /// Covariance of c₁ … c_N.
    covariance: Matrix,
    /// Exposure of each image over the first's.
    pub ratios: Vec<f64>,
    /// Root mean square disagreement of pairs, relative to the maximum light.
    pub residual: f64,
}

/// Settings of a response estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseSettings {
    /// Reading of a saturated pixel.
    pub full_scale: f64,
    /// Reading without light.
    pub black: f64,
    /// Maximum degree.
    pub degree: usize,
    /// True to estimate the exposure ratios as well.
    pub refine: bool,
}

/// Range of readings used: away from black and saturation, as fractions of the range.
const USABLE_RANGE: core::ops::Range<f64> = 0.02..0.98;
/// Pixels used from each pair, uniformly distributed.
const PIXELS: usize = 20_000;

/// A pair of readings of one pixel, with the indices of their images.
#[derive(Clone, Copy)]
struct ReadingPair {
    low: f64,
    high: f64,
    pictures: (usize, usize),
}

/// Estimates the response of the camera from images of one scene at the given exposures.
///
/// # Errors
/// If there are too few images, pixels or exposures.
pub fn camera_response(images: &[(f64, &Image)], settings: &ResponseSettings) -> Result<Response, OecfError> {
    let mut sorted: Vec<(f64, &Image)> = images.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    if sorted.len() < 2 {
        return Err(OecfError::TooFew(sorted.len()));
    }
    if let Some((exposure, _)) = sorted.iter().find(|(e, _)| !(*e > 0.0 && e.is_finite())) {
        return Err(OecfError::Exposure(*exposure));
    }
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        return Err(OecfError::Twice(pair[0].0));
    }
    if sorted.windows(2).any(|pair| pair[0].1 == pair[1].1) {
        return Err(OecfError::Flat);
    }
    let mut exposures: Vec<f64> = sorted.iter().map(|(e, _)| e / sorted[0].0).collect();
    let pairs = pairs(&sorted, settings);
    if pairs.len() < 100 {
        return Err(OecfError::Flat);
    }
    let rounds = if settings.refine { 30 } else { 1 };
    let mut best = search(&pairs, &exposures, settings.degree)?;
    for _ in 1..rounds {
        exposures = refined(&pairs, &best, exposures.len());
        best = search(&pairs, &exposures, settings.degree)?;
    }
    Ok(Response { ratios: exposures, ..best })
}

fn pairs(images: &[(f64, &Image)], settings: &ResponseSettings) -> Vec<ReadingPair> {
    let fraction = |s: f32| (f64::from(s) - settings.black) / (settings.full_scale - settings.black);
    let mut pairs = Vec::new();
    for (q, two) in images.windows(2).enumerate() {
        let (low, high) = (two[0].1.samples(), two[1].1.samples());
        let step = (low.len() / PIXELS).max(1);
        let both = low.iter().zip(high).step_by(step).map(|(a, b)| (fraction(*a), fraction(*b)));
        let usable = both.filter(|(a, b)| USABLE_RANGE.contains(a) && USABLE_RANGE.contains(b));
        pairs.extend(usable.map(|(low, high)| ReadingPair { low, high, pictures: (q, q + 1) }));
    }
    pairs
}

/// The lowest sufficient degree.
fn search(pairs: &[ReadingPair], exposures: &[f64], max_degree: usize) -> Result<Response, OecfError> {
    let mut best: Option<Response> = None;
    for degree in 1..=max_degree.max(1) {
        let Some(next) = fitted(pairs, exposures, degree, 0.0) else { continue };
        let free = pairs.len() as f64;
        // Standard deviation of a variance over this many pairs.
        let better =
            |b: &Response| next.residual * next.residual < b.residual * b.residual * (1.0 - 2.0 * (2.0 / free).sqrt());
        if best.as_ref().is_none_or(better) {
            best = Some(next);
        }
    }
    let mut best = best.ok_or(OecfError::Flat)?;
    for _ in 0..4 {
        let degree = best.coefficients.len() - 1;
        let Some(next) = fitted(pairs, exposures, degree, best.residual * best.residual) else { break };
        best = next;
    }
    Ok(best)
}

/// The polynomial of a degree, for readings of a given noise variance.
fn fitted(pairs: &[ReadingPair], exposures: &[f64], degree: usize, noise: f64) -> Option<Response> {
    let mut response = Response {
        coefficients: [0.0, 1.0].into_iter().chain(core::iter::repeat_n(0.0, degree - 1)).collect(),
        covariance: Matrix::zeros(0, 0),
        ratios: exposures.to_vec(),
        residual: f64::NAN,
    };
    for _ in 0..3 {
        let mut normal = Normal::new(degree);
        let (mut squares, mut weights) = (0.0, 0.0);
        for pair in pairs {
            let (row, constant) = equation(pair, exposures, degree);
            let ratio = exposures[pair.pictures.1] / exposures[pair.pictures.0];
            let scatter = |m: f64| response.slope(m) * response.slope(m);
            let weight = 1.0 / (ratio * ratio * scatter(pair.low) + scatter(pair.high)).max(1e-12);
            let residual: f64 = constant + row.iter().zip(&response.coefficients[1..]).map(|(r, c)| r * c).sum::<f64>();
            squares += weight * residual * residual;
            weights += 1.0;
            normal.add(&row, -constant, weight);
            // Contribution of the noise of the two readings to the squares.
            normal.add(&gradient(pair.high, degree, 1.0), -1.0, -weight * noise);
            normal.add(&gradient(pair.low, degree, ratio), -ratio, -weight * noise);
        }
        let solved = normal.solve()?;
        let variance = squares / (weights - degree as f64);
        response.covariance = normal.inverse()?.scaled(variance);
        response.coefficients = core::iter::once(0.0).chain(solved).collect();
        // f(1) = 1 fixes the scale.
        response.normalise();
        response.residual = variance.sqrt();
    }
    Some(response)
}

/// The equation f(M_high) − R f(M_low) = 0 with f(M) = M + Σ_(n ≥ 2) c_n (Mⁿ − M) + …, as a row of c₁ … c_N and a constant. c₁ is
/// replaced by 1 − Σ c_n, so that f(1) = 1: its own column is a weak tie to that value.
fn equation(pair: &ReadingPair, exposures: &[f64], degree: usize) -> (Vec<f64>, f64) {
    let ratio = exposures[pair.pictures.1] / exposures[pair.pictures.0];
    let constant = pair.high - ratio * pair.low;
    let powers = |m: f64, n: usize| (1..n).fold(m, |p, _| p * m) - m;
    let term = |n: usize| if n == 1 { 1e-9 } else { powers(pair.high, n) - ratio * powers(pair.low, n) };
    ((1..=degree).map(term).collect(), constant)
}

/// Derivative of a pair's row by a reading: n Mⁿ⁻¹ − 1.
fn gradient(reading: f64, degree: usize, ratio: f64) -> Vec<f64> {
    let power = |n: usize| (1..n).fold(1.0, |p, _| p * reading);
    (1..=degree).map(|n| if n == 1 { 0.0 } else { ratio * (n as f64 * power(n) - 1.0) }).collect()
}

/// Exposure ratios that the response implies: medians of f(M_high)/f(M_low).
fn refined(pairs: &[ReadingPair], response: &Response, images: usize) -> Vec<f64> {
    let mut exposures = vec![1.0; images];
    for q in 1..images {
        let own_pairs = pairs.iter().filter(|p| p.pictures.1 == q);
        let mut ratios: Vec<f64> = own_pairs.map(|p| response.light(p.high) / response.light(p.low)).collect();
        ratios.sort_unstable_by(f64::total_cmp);
        let ratio = ratios.get(ratios.len() / 2).copied().filter(|r| r.is_finite() && *r > 0.0).unwrap_or(1.0);
        exposures[q] = exposures[q - 1] * ratio;
    }
    exposures
}

impl Response {
    fn normalise(&mut self) {
        let rest: f64 = self.coefficients[2..].iter().sum();
        self.coefficients[1] = 1.0 - rest;
    }

    /// Light of a reading over full scale, relative to the maximum light.
    #[must_use]
    pub fn light(&self, reading: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * reading + c)
    }

    /// The same with its uncertainty, from the disagreement of pairs.
    #[must_use]
    pub fn estimate(&self, reading: f64) -> Estimate {
        let slope = |n: usize| if n == 1 { 0.0 } else { (1..n).fold(reading, |p, _| p * reading) - reading };
        let slopes: Vec<f64> = (1..self.coefficients.len()).map(slope).collect();
        Estimate::new(self.light(reading), self.covariance.form(&slopes).max(0.0).sqrt())
    }

    fn slope(&self, reading: f64) -> f64 {
        let terms = self.coefficients.iter().enumerate().skip(1).rev();
        terms.fold(0.0, |sum, (n, c)| sum * reading + n as f64 * c)
    }
}
