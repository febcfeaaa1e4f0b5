//! Time series, and the frequency that explains them.

use core::f64::consts::TAU;

use etendue_core::maths::f64::{atan2, hypot, ln, sin_cos};

use crate::Estimate;
use crate::linear::{Cholesky, Matrix};

/// Maximum number of harmonics, including the fundamental.
const MAX_HARMONICS: usize = 7;
/// Minimum number of periods that distinguishes shading from bands.
const PERIODS_FOR_SHADING: f64 = 3.0;
/// Maximum error of a frequency, in multiples of the frame rate to either side, that is considered.
const MAX_ALIAS: f64 = 64.0;
/// Minimum number of periods of a detectable frequency.
const MIN_PERIODS: f64 = 1.5;
/// Minimum improvement of the criterion by the fundamental, in addition to that for the number of frequencies tried, and by a
/// frequency relative to its aliases over frames: exceeded by chance in one of 150.
const MIN_GAIN: f64 = 10.0;

/// Blocks of numbers at equal steps: rows of frames, or frames.
#[derive(Clone, Debug)]
pub(super) struct TimeSeries {
    /// Start of each block, s, and its numbers.
    pub(super) blocks: Vec<(f64, Vec<f64>)>,
    /// Time from one number of a block to the next, s.
    pub(super) step_s: f64,
}

/// A fitted level, its shading, and a Fourier series.
#[derive(Clone, Debug)]
pub(super) struct FourierFit {
    pub(super) frequency_hz: Estimate,
    pub(super) harmonics: usize,
    pub(super) shading: bool,
    coefficients: Vec<f64>,
    covariance: Matrix,
    /// Sum of squared residuals, and the numbers of values and parameters.
    pub(super) squares: f64,
    pub(super) count: usize,
    pub(super) parameters: usize,
}

/// Information criterion of a fit: less is better.
pub(super) fn criterion(squares: f64, count: usize, parameters: usize) -> f64 {
    let n = count as f64;
    n * ln((squares / n).max(f64::MIN_POSITIVE)) + parameters as f64 * ln(n)
}

struct LeastSquares {
    coefficients: Vec<f64>,
    squares: f64,
    residuals: Vec<f64>,
    inverse: Matrix,
}

impl TimeSeries {
    pub(super) fn count(&self) -> usize {
        self.blocks.iter().map(|(_, values)| values.len()).sum()
    }

    fn block_length_s(&self) -> f64 {
        self.blocks.iter().map(|(_, values)| values.len()).max().unwrap_or(0) as f64 * self.step_s
    }

    pub(super) fn length_s(&self) -> f64 {
        let last = self.blocks.last().map_or(0.0, |(start_s, _)| *start_s);
        last - self.blocks.first().map_or(0.0, |(start_s, _)| *start_s) + self.block_length_s()
    }

    /// Time (s) of each number, and its position in its block, −1 … 1.
    pub(super) fn times(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.blocks.iter().flat_map(move |(start_s, values)| {
            let middle = 0.5 * (values.len() as f64 - 1.0);
            (0..values.len()).map(move |i| (start_s + i as f64 * self.step_s, (i as f64 - middle) / middle.max(1.0)))
        })
    }

    pub(super) fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.blocks.iter().flat_map(|(_, values)| values.iter().copied())
    }

    /// A level, and with shading a slope and a curvature over the block with zero mean.
    pub(super) fn level_columns(&self, shading: bool) -> Vec<Vec<f64>> {
        let u: Vec<f64> = self.times().map(|(_, u)| u).collect();
        let mean = u.iter().map(|u| u * u).sum::<f64>() / u.len() as f64;
        let ones = vec![1.0; u.len()];
        match shading {
            false => vec![ones],
            true => vec![ones, u.clone(), u.iter().map(|u| u * u - mean).collect()],
        }
    }

    fn columns(&self, frequency_hz: f64, harmonics: usize, shading: bool) -> Vec<Vec<f64>> {
        let mut columns = self.level_columns(shading);
        for h in 1..=harmonics {
            let phases = self.times().map(|(time_s, _)| {
                let periods = h as f64 * frequency_hz * time_s;
                sin_cos(TAU * (periods - periods.round()))
            });
            let (sines, cosines): (Vec<f64>, Vec<f64>) = phases.unzip();
            columns.extend([cosines, sines]);
        }
        columns
    }

    fn fit(&self, columns: &[Vec<f64>]) -> Option<LeastSquares> {
        let values: Vec<f64> = self.values().collect();
        least_squares(columns, &values)
    }

    fn squares(&self, frequency_hz: f64, harmonics: usize, shading: bool) -> f64 {
        self.fit(&self.columns(frequency_hz, harmonics, shading)).map_or(f64::INFINITY, |fit| fit.squares)
    }

    /// The lowest detectable frequency, Hz.
    pub(super) fn lowest_hz(&self) -> f64 {
        MIN_PERIODS / self.length_s()
    }

    /// The frequency that explains most, with its harmonics; `None` if none is significant, or if it cannot be distinguished from
    /// others.
    pub(super) fn find_frequency(&self, highest_hz: f64) -> Option<FourierFit> {
        let is_valid = |fit: &FourierFit| {
            fit.frequency_hz.value >= self.lowest_hz() && fit.frequency_hz.standard_uncertainty.is_finite()
        };
        self.strongest_fit(highest_hz).filter(is_valid)
    }

    fn strongest_fit(&self, highest_hz: f64) -> Option<FourierFit> {
        let with_shading = self.blocks[0].1.len() >= 8;
        let fitted = |shading: bool| self.fit_below(highest_hz, shading);
        let is_valid = |fit: &FourierFit| fit.frequency_hz.value * self.block_length_s() >= PERIODS_FOR_SHADING;
        fitted(with_shading).filter(|fit| !fit.shading || is_valid(fit)).or_else(|| fitted(false))
    }

    fn fit_below(&self, highest_hz: f64, shading: bool) -> Option<FourierFit> {
        let start_hz = self.strongest(highest_hz, shading)?;
        let reach_hz = 0.25 / self.length_s();
        let frequency_hz = self.refined(start_hz, reach_hz, 1, shading);
        self.is_significant(frequency_hz, shading, highest_hz).then_some(())?;
        let frequency_hz = self.best_alias(frequency_hz, highest_hz, shading)?;
        let (frequency_hz, harmonics) = self.with_harmonics(frequency_hz, reach_hz, highest_hz, shading)?;
        self.finished(frequency_hz, harmonics, shading)
    }

    /// The one of the frequencies indistinguishable between blocks that explains most; `None` if another explains as much within
    /// chance.
    fn best_alias(&self, frequency_hz: f64, highest_hz: f64, shading: bool) -> Option<f64> {
        let aliases =
            self.aliases_of(frequency_hz).into_iter().filter(|f| (0.5 / self.length_s()..=highest_hz).contains(f));
        let all: Vec<(f64, f64)> = aliases.map(|f| (f, self.best_harmonics(f, highest_hz, shading).1)).collect();
        let best = *all.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let another = |(f, _): &&(f64, f64)| (f - best.0).abs() > 0.5 / self.length_s();
        let next = all.iter().filter(another).map(|(_, criterion)| *criterion).fold(f64::INFINITY, f64::min);
        (next - best.1 > MIN_GAIN).then_some(best.0)
    }

    /// The frequency with as many harmonics as the criterion supports, each of which may shift it.
    fn with_harmonics(&self, start_hz: f64, reach_hz: f64, highest_hz: f64, shading: bool) -> Option<(f64, usize)> {
        let level = if shading { 3 } else { 1 };
        let next = |f: &mut f64, h: usize| {
            *f = self.refined(*f, reach_hz / h as f64, h, shading);
            Some((*f, h, criterion(self.squares(*f, h, shading), self.count(), level + 1 + 2 * h)))
        };
        let all = (1..=self.most_harmonics(start_hz, highest_hz)).scan(start_hz, next);
        all.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(f, h, _)| (f, h))
    }

    fn most_harmonics(&self, frequency_hz: f64, highest_hz: f64) -> usize {
        MAX_HARMONICS.min((highest_hz / frequency_hz) as usize).min(self.count() / 6).max(1)
    }

    /// Number of harmonics that the criterion supports, and the value of the criterion.
    fn best_harmonics(&self, frequency_hz: f64, highest_hz: f64, shading: bool) -> (usize, f64) {
        let level = if shading { 3 } else { 1 };
        let criterion_with =
            |h: usize| criterion(self.squares(frequency_hz, h, shading), self.count(), level + 1 + 2 * h);
        (1..=self.most_harmonics(frequency_hz, highest_hz))
            .map(|h| (h, criterion_with(h)))
            .fold((1, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
    }

    /// Frequencies with the same phases, or the opposite ones, at the starts of blocks at equal steps: they differ only within the
    /// blocks. For a light with harmonics the fundamental alone may prefer a wrong one.
    fn aliases_of(&self, frequency_hz: f64) -> Vec<f64> {
        let [first, second, ..] = &self.blocks[..] else { return vec![frequency_hz] };
        let rate_hz = 1.0 / (second.0 - first.0);
        let reach = (1.5 / (self.block_length_s() * rate_hz)).ceil().min(MAX_ALIAS) as i32;
        let nearest = (frequency_hz / rate_hz).round();
        let orders = (-reach..=reach).map(|k| (nearest + f64::from(k)) * rate_hz);
        let remainder_hz = frequency_hz - nearest * rate_hz;
        orders.flat_map(|order| [order + remainder_hz, order - remainder_hz]).collect()
    }

    /// True if the fundamental improves the criterion more than the best of this many frequencies would by chance.
    fn is_significant(&self, frequency_hz: f64, shading: bool, highest_hz: f64) -> bool {
        let Some(level) = self.fit(&self.level_columns(shading)) else { return false };
        let (n, trials) = (self.count() as f64, (highest_hz * self.length_s()).max(1.0));
        // An exact fit of exact numbers.
        let squares = self.squares(frequency_hz, 1, shading).max(level.squares * 1e-24);
        level.squares > 0.0 && n * ln(level.squares / squares) > 3.0 * ln(n) + 2.0 * ln(trials) + MIN_GAIN
    }

    /// The maximum of the periodogram: coarse over the blocks separately, then near it over all of them together.
    fn strongest(&self, highest_hz: f64, shading: bool) -> Option<f64> {
        let level = self.fit(&self.level_columns(shading))?;
        let columns = self.level_columns(shading);
        let explained =
            |i: usize| columns.iter().zip(&level.coefficients).map(|(column, c)| c * column[i]).sum::<f64>();
        let rest: Vec<f64> = self.values().enumerate().map(|(i, value)| value - explained(i)).collect();
        let block_s = self.block_length_s();
        let coarse = best(0.25 / block_s, highest_hz, 0.25 / block_s, |f| {
            self.transforms(&rest, f).map(|[re, im]| re * re + im * im).sum()
        })?;
        let length_s = self.length_s();
        if self.blocks.len() == 1 {
            return Some(coarse);
        }
        let (low, high) = ((coarse - 1.0 / block_s).max(0.5 / length_s), (coarse + 1.0 / block_s).min(highest_hz));
        best(low, high, 0.15 / length_s, |f| {
            let sum = self.transforms(&rest, f).zip(&self.blocks).fold([0.0; 2], |sum, (part, (start_s, _))| {
                let (sin, cos) = sin_cos(-TAU * (f * start_s - (f * start_s).round()));
                [sum[0] + part[0] * cos - part[1] * sin, sum[1] + part[0] * sin + part[1] * cos]
            });
            sum[0] * sum[0] + sum[1] * sum[1]
        })
    }

    /// Transform of each block, as if it started at time 0.
    fn transforms<'a>(&'a self, rest: &'a [f64], frequency_hz: f64) -> impl Iterator<Item = [f64; 2]> + 'a {
        let (sin, cos) = sin_cos(-TAU * frequency_hz * self.step_s);
        let mut next = 0;
        self.blocks.iter().map(move |(_, values)| {
            let part = &rest[next..next + values.len()];
            next += values.len();
            let mut turn = [1.0, 0.0];
            part.iter().fold([0.0; 2], |sum, value| {
                let [re, im] = turn;
                turn = [re * cos - im * sin, re * sin + im * cos];
                [sum[0] + value * re, sum[1] + value * im]
            })
        })
    }

    /// The minimum of the sum of squares within a range, by golden section.
    fn refined(&self, start_hz: f64, reach_hz: f64, harmonics: usize, shading: bool) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_895;
        let (mut low, mut high) = ((start_hz - reach_hz).max(0.05 * start_hz), start_hz + reach_hz);
        let squares_at = |f: f64| self.squares(f, harmonics, shading);
        let place = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let [mut a, mut b] = place(low, high);
        let (mut at_a, mut at_b) = (squares_at(a), squares_at(b));
        for _ in 0..40 {
            if at_a < at_b {
                (high, b, at_b) = (b, a, at_a);
                a = place(low, high)[0];
                at_a = squares_at(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = place(low, high)[1];
                at_b = squares_at(b);
            }
        }
        0.5 * (low + high)
    }

    /// The fit at a frequency, with the uncertainty from the curvature of the sum of squares.
    fn finished(&self, frequency_hz: f64, harmonics: usize, shading: bool) -> Option<FourierFit> {
        let fit = self.fit(&self.columns(frequency_hz, harmonics, shading))?;
        let (count, parameters) = (self.count(), fit.coefficients.len() + 1);
        let variance =
            fit.squares / count.saturating_sub(parameters).max(1) as f64 * self.correlation_factor(&fit.residuals);
        let step = 0.05 / (self.length_s() * harmonics as f64);
        let [below, above] = [-step, step].map(|d| self.squares(frequency_hz + d, harmonics, shading));
        let curvature = (below - 2.0 * fit.squares + above) / (step * step);
        let u = if curvature > 0.0 { (2.0 * variance / curvature).sqrt() } else { f64::INFINITY };
        let mut covariance = fit.inverse;
        for i in 0..fit.coefficients.len() {
            (0..fit.coefficients.len()).for_each(|j| *covariance.at_mut(i, j) *= variance);
        }
        let frequency_hz = Estimate::new(frequency_hz, u);
        let (coefficients, squares) = (fit.coefficients, fit.squares);
        Some(FourierFit { frequency_hz, harmonics, shading, coefficients, covariance, squares, count, parameters })
    }
}

impl TimeSeries {
    /// Variance factor for correlated errors of neighbours (for example where a series cannot follow an edge): (1 + ρ)/(1 − ρ) with
    /// their correlation ρ, at least 1 (as for a first-order autoregression).
    fn correlation_factor(&self, residuals: &[f64]) -> f64 {
        let mut next = 0;
        let (mut products, mut squares) = (0.0, 0.0);
        for (_, values) in &self.blocks {
            let part = &residuals[next..next + values.len()];
            next += values.len();
            products += part.array_windows().map(|[a, b]| a * b).sum::<f64>();
            squares += part.iter().map(|r| r * r).sum::<f64>();
        }
        // Correlations that independent errors show by chance are ignored.
        let correlation = if squares > 0.0 { products / squares } else { 0.0 };
        let significance = 2.0 / (residuals.len() as f64).sqrt();
        if correlation > significance { (1.0 + correlation) / (1.0 - correlation).max(1e-6) } else { 1.0 }
    }
}

/// The position from `low` to `high`, in equal steps, of the maximum; `None` if there is no step.
fn best(low: f64, high: f64, step: f64, value: impl Fn(f64) -> f64) -> Option<f64> {
    let steps = ((high - low) / step).floor();
    let places = (0..=steps.max(-1.0) as i64).map(|i| low + i as f64 * step);
    places.map(|place| (place, value(place))).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Coefficients of the columns that fit the values best.
fn least_squares(columns: &[Vec<f64>], values: &[f64]) -> Option<LeastSquares> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut normal = Matrix::zeros(columns.len(), columns.len());
    for i in 0..columns.len() {
        for j in 0..=i {
            let product = dot(&columns[i], &columns[j]);
            (*normal.at_mut(i, j), *normal.at_mut(j, i)) = (product, product);
        }
    }
    let right: Vec<f64> = columns.iter().map(|column| dot(column, values)).collect();
    let factor = Cholesky::new(&normal, 1e-10)?;
    let coefficients = factor.solve(&right);
    let rest = |(i, value): (usize, &f64)| {
        let explained: f64 = columns.iter().zip(&coefficients).map(|(column, c)| c * column[i]).sum();
        value - explained
    };
    let residuals: Vec<f64> = values.iter().enumerate().map(rest).collect();
    let squares = residuals.iter().map(|r| r * r).sum();
    Some(LeastSquares { coefficients, squares, residuals, inverse: factor.inverse() })
}

/// Coefficients of the columns that fit the series best, and the sum of squares of the residuals.
pub(super) fn explained(series: &TimeSeries, columns: &[Vec<f64>]) -> Option<(Vec<f64>, f64)> {
    series.fit(columns).map(|fit| (fit.coefficients, fit.squares))
}

impl FourierFit {
    /// Index of the first harmonic among the coefficients.
    fn first(&self) -> usize {
        if self.shading { 3 } else { 1 }
    }

    /// The level.
    pub(super) fn mean(&self) -> f64 {
        self.coefficients[0]
    }

    /// Number of parameters of the level and the shading.
    pub(super) fn level_parameters(&self) -> usize {
        self.first()
    }

    /// The fundamental's amplitude over the mean.
    pub(super) fn amplitude_ratio(&self) -> Estimate {
        let first = self.first();
        let (a, b) = (self.coefficients[first], self.coefficients[first + 1]);
        let (amplitude, mean) = (hypot(a, b), self.coefficients[0]);
        let mut slopes = vec![0.0; self.coefficients.len()];
        slopes[0] = -amplitude / (mean * mean);
        (slopes[first], slopes[first + 1]) = (a / (amplitude * mean), b / (amplitude * mean));
        Estimate::new(amplitude / mean, self.uncertainty(&slopes))
    }

    /// Time of the fundamental's maximum, in periods after time 0.
    pub(super) fn peak_periods(&self) -> f64 {
        let first = self.first();
        atan2(self.coefficients[first + 1], self.coefficients[first]) / TAU
    }

    /// (max − min)/(max + min) of the fitted series.
    pub(super) fn michelson(&self) -> Estimate {
        const PHASES: u32 = 720;
        let at = |slopes: &[f64]| slopes.iter().zip(&self.coefficients).map(|(s, c)| s * c).sum::<f64>();
        let all = (0..PHASES).map(|i| self.slopes_at(f64::from(i) / f64::from(PHASES)));
        let mut all: Vec<(f64, Vec<f64>)> = all.map(|slopes| (at(&slopes), slopes)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ((low, low_slopes), (high, high_slopes)) = (&all[0], &all[all.len() - 1]);
        let total = high + low;
        // ∂/∂high = 2 low/total², ∂/∂low = −2 high/total².
        let slope = |(l, h): (&f64, &f64)| 2.0 * (low * h - high * l) / (total * total);
        let slopes: Vec<f64> = low_slopes.iter().zip(high_slopes).map(slope).collect();
        Estimate::new((high - low) / total, self.uncertainty(&slopes))
    }

    /// Contribution of each coefficient to the series at a phase, without shading.
    fn slopes_at(&self, phase: f64) -> Vec<f64> {
        let mut slopes = vec![0.0; self.coefficients.len()];
        slopes[0] = 1.0;
        for h in 1..=self.harmonics {
            let (sin, cos) = sin_cos(TAU * h as f64 * phase);
            let at = self.first() + 2 * (h - 1);
            (slopes[at], slopes[at + 1]) = (cos, sin);
        }
        slopes
    }

    fn uncertainty(&self, slopes: &[f64]) -> f64 {
        let n = slopes.len();
        let terms = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        terms.map(|(i, j)| slopes[i] * self.covariance.at(i, j) * slopes[j]).sum::<f64>().max(0.0).sqrt()
    }
}
