//! Uncertainty of the coefficients of a profile.
//!
//! With B the inverse of XᵀX, x_i the row of a pixel, e_i its residual and h_i = x_iᵀ B x_i its leverage (White 1980, MacKinnon &
//! White 1985; Conley 1999 for noise that neighbours share):
//!
//! ```text
//! C = B (Σ_i Σ_l ε_i ε_{i+l} x_i x_{i+l}ᵀ) B       ε_i = e_i/(1 − h_i)^κ; l: 0 and the shifts of up to one pixel more than those
//! at which
//!                                                 |Σ e_i e_{i+l}| > 4 √(Σ e_i² e_{i+l}²), four pixels at most
//! κ                                               1/2 without such shifts, 1 with them (a fit follows shared noise more)
//! ```
//!
//! The limit is four standard deviations of independent noise of any, even varying, strength: rendered images without sensor
//! noise have nearly all of it in the few pixels that the edge crosses, so that the effective number of pixels is small. Raw
//! images have no such shifts. Demosaicing, noise reduction and scaling spread noise over neighbours; C includes the frequencies
//! at which they raised and lowered it. As the sum is truncated after a few pixels, C may become negative if residuals are not
//! noise (steps that splines cannot follow): a variance below a tenth of that without shifts is replaced by the latter.

use super::knots::{Row, Sample};
use crate::{Image, linear::Matrix};

/// Maximum shift, px, and minimum significant correlation, in its own standard deviations for independent noise.
const MAX_SHIFT_PX: isize = 4;
const MIN_SIGNIFICANCE: f64 = 4.0;

/// Covariance with shared noise, if any, and without.
pub(super) struct Covariance {
    shared: Option<Matrix>,
    own: Matrix,
}

/// Minimum accepted fraction of the variance without shared noise.
const MIN_UNSHARED_FRACTION: f64 = 0.1;

impl Covariance {
    /// Covariance of coefficients fitted to samples with these residuals; `inverse` is B.
    pub(super) fn new(rows: &[Row], samples: &[Sample], residuals: &[f64], image: &Image, inverse: &Matrix) -> Self {
        let neighbours = SampleIndex::new(samples, image);
        let shifts = neighbours.correlated(residuals);
        let leverages: Vec<f64> = rows.iter().map(|row| leverage(row, inverse)).collect();
        let free = |i: usize| 1.0 - leverages[i].min(0.9);
        let scaled = |power: fn(f64) -> f64| residuals.iter().enumerate().map(|(i, e)| e / power(free(i))).collect();
        let shared = (!shifts.is_empty()).then(|| {
            let residuals: Vec<f64> = scaled(|f| f);
            let near =
                |i: usize| shifts.iter().filter_map(|s| neighbours.neighbour(samples[i].pixel, s.0, s.1)).collect();
            sandwich(rows, &residuals, near, inverse)
        });
        let residuals: Vec<f64> = scaled(f64::sqrt);
        Self { shared, own: sandwich(rows, &residuals, |_| Vec::new(), inverse) }
    }

    /// Variance of a weighted sum of the coefficients.
    pub(super) fn variance(&self, weights: &[f64]) -> f64 {
        let own = self.own.form(weights).max(0.0);
        let shared = self.shared.as_ref().map(|c| c.form(weights));
        shared.filter(|v| *v > MIN_UNSHARED_FRACTION * own).unwrap_or(own)
    }
}

/// x B xᵀ.
fn leverage(row: &Row, inverse: &Matrix) -> f64 {
    row.0.iter().map(|(i, a)| a * row.0.iter().map(|(j, b)| b * inverse.at(*i, *j)).sum::<f64>()).sum()
}

/// B (Σ_i e_i x_i (e_i x_i + Σ_j e_j x_j)ᵀ) B over the neighbours j of each i.
fn sandwich(rows: &[Row], residuals: &[f64], near: impl Fn(usize) -> Vec<usize>, inverse: &Matrix) -> Matrix {
    let unknowns = inverse.rows();
    let mut meat = Matrix::zeros(unknowns, unknowns);
    let mut sum = vec![0.0; unknowns];
    for (i, row) in rows.iter().enumerate() {
        let others: Vec<usize> = near(i).into_iter().chain([i]).collect();
        others.iter().for_each(|j| rows[*j].0.iter().for_each(|(k, value)| sum[*k] += residuals[*j] * value));
        for (k, value) in &row.0 {
            let own = residuals[i] * value;
            sum.iter().enumerate().filter(|(_, s)| **s != 0.0).for_each(|(m, s)| *meat.at_mut(*k, m) += own * s);
        }
        others.iter().for_each(|j| rows[*j].0.iter().for_each(|(k, _)| sum[*k] = 0.0));
    }
    inverse.times_symmetric(&meat).times_symmetric(inverse)
}

/// Index of the sample of each pixel.
struct SampleIndex {
    width: isize,
    samples: Vec<Option<usize>>,
}

impl SampleIndex {
    fn new(samples: &[Sample], image: &Image) -> Self {
        let mut places = vec![None; image.samples().len()];
        samples.iter().enumerate().for_each(|(i, s)| places[s.pixel] = Some(i));
        Self { width: image.width() as isize, samples: places }
    }

    fn neighbour(&self, pixel: usize, dx: isize, dy: isize) -> Option<usize> {
        let at = pixel as isize;
        let column = at % self.width + dx;
        let place = usize::try_from(at + dy * self.width + dx).ok()?;
        (0..self.width).contains(&column).then(|| self.samples.get(place).copied().flatten())?
    }

    /// Shifts within the reach of those with correlated or anticorrelated noise.
    fn correlated(&self, residuals: &[f64]) -> Vec<(isize, isize)> {
        let pixels: Vec<usize> = (0..self.samples.len()).filter(|p| self.samples[*p].is_some()).collect();
        let range = || -MAX_SHIFT_PX..=MAX_SHIFT_PX;
        let shifts = range().flat_map(|dy| range().map(move |dx| (dx, dy))).filter(|shift| *shift != (0, 0));
        let counts = |shift: &(isize, isize)| {
            let pair =
                |p: &usize| Some(residuals[self.samples[*p]?] * residuals[self.neighbour(*p, shift.0, shift.1)?]);
            let (mut sum, mut squares) = (0.0, 0.0);
            pixels.iter().filter_map(pair).for_each(|product| {
                sum += product;
                squares += product * product;
            });
            sum * sum > MIN_SIGNIFICANCE * MIN_SIGNIFICANCE * squares
        };
        let significant = shifts.clone().filter(counts);
        let reach = significant.map(|(dx, dy)| dx.abs().max(dy.abs()) + 1).max();
        shifts.filter(|(dx, dy)| reach.is_some_and(|reach| dx.abs().max(dy.abs()) <= reach)).collect()
    }
}
