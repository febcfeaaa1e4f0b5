//! Fixed patterns: spatial variances of an image with the temporal part removed.
//!
//! EMVA 1288 release 4.0 (linear), section on spatial nonuniformity. M rows, N columns, L frames, ȳ the average frame:
//!
//! ```text
//! s²    = Var(ȳ) − σ²/L                       (denominator MN − 1)
//! s_rav² = ⟨(row average − mean)²⟩ − σ_r²/L   σ_r²: temporal variance of row averages
//! s_cav² = ⟨(column average − mean)²⟩ − σ_c²/L
//! s_col² = ((MN − M) s_cav² − N (s² − s_rav²))/D          D = MN − M − N
//! s_row² = ((MN − N) s_rav² − M (s² − s_cav²))/D
//! s_pix² = MN (s² − s_cav² − s_rav²)/D
//! ```
//!
//! The standard uses σ²/N for σ_r² and σ²/M for σ_c², which is correct for independent pixel noise. Here they are measured, so
//! that temporal row noise does not count as a fixed pattern. Without such noise the two agree.
//!
//! Uncertainty. All of these are linear in three mean squares of the analysis of variance (rows, columns, residual), which for
//! normal patterns are independent scaled χ² of M − 1, N − 1 and (M − 1)(N − 1) degrees of freedom: exact except for the temporal
//! terms, which are added as independent. The uncertainty of the residual is increased by its measured kurtosis (hot pixels). It
//! is the uncertainty for the **population** of which this sensor is a sample: use it for comparisons with declared parameters.
//!
//! Power spectra of the rows and columns of an image, which reveal periodic patterns.
//!
//! EMVA 1288 release 3.1 and 4.0, section on spectrograms: the Fourier transform of each row of the averaged image less its mean,
//! over √N; the squared magnitudes are averaged over the rows:
//!
//! ```text
//! p[k] = ⟨|Σ_n (y[n] − ȳ) exp(−2πi k n/N)|²/N⟩      k = 0 … N/2, frequency k/N cycles per pixel
//! ```
//!
//! White noise of variance s² has p = s² at every frequency. The remaining temporal noise σ² of L frames is the white level σ²/L,
//! which the standard draws as a line.

use super::{Stack, TransferError};
use crate::{Estimate, fourier::transform};

/// Variances, DN², of a pattern and its components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VarianceComponents<T> {
    pub total: T,
    /// Row to row.
    pub row: T,
    /// Column to column.
    pub column: T,
    /// Pixel to pixel.
    pub pixel: T,
}

impl<T> VarianceComponents<T> {
    /// Maps the components in a fixed order: total, row, column, pixel.
    pub fn map<U>(self, f: impl FnMut(T) -> U) -> VarianceComponents<U> {
        let [total, row, column, pixel] = [self.total, self.row, self.column, self.pixel].map(f);
        VarianceComponents { total, row, column, pixel }
    }
}

/// Fixed pattern of a stack, as an analysis of variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    rows: f64,
    columns: f64,
    frames: f64,
    pub mean_dn: Estimate,
    /// Mean squares of rows, columns and residual, DN², over their degrees of freedom.
    squares: [f64; 3],
    /// Excess kurtosis of the residual.
    kurtosis: f64,
    /// Temporal variance of pixels, row averages and column averages, DN².
    temporal: [f64; 3],
}

impl Pattern {
    /// Analyses a stack of frames.
    ///
    /// # Errors
    /// If there are fewer than two frames, or fewer than three rows or columns.
    pub fn from_stack(stack: &Stack) -> Result<Self, TransferError> {
        let (width, height) = (stack.width(), stack.height());
        let temporal = stack.temporal()?;
        if width < 3 || height < 3 {
            return Err(TransferError::TooSmall { width, height });
        }
        let (average, mean_dn) = (stack.average(), stack.statistics()?.mean_dn);
        let (rows, columns) = deviations(&average, width, mean_dn.value);
        let square = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
        let residual = residual(&average, &rows, &columns, mean_dn.value);
        let (m, n) = (height as f64, width as f64);
        let squares = [
            n * square(&rows) / (m - 1.0),
            m * square(&columns) / (n - 1.0),
            residual.second_moment * m * n / ((m - 1.0) * (n - 1.0)),
        ];
        Ok(Self {
            rows: m,
            columns: n,
            frames: stack.frames() as f64,
            mean_dn,
            squares,
            kurtosis: residual.kurtosis(),
            temporal,
        })
    }

    /// The variances with their uncertainties.
    #[must_use]
    pub fn variances_dn2(&self) -> VarianceComponents<Estimate> {
        self.parts_with(|k| self.spread(k) * self.squares[k] * self.squares[k])
    }

    /// Variances of this pattern less those of `dark`, which shares its offsets: the scatter of the dark pattern is in both and
    /// cancels.
    #[must_use]
    pub fn without_dark(&self, dark: &Self) -> VarianceComponents<Estimate> {
        let variance = |k: usize| {
            let common = (dark.squares[k] - dark.remainder(k)).max(0.0);
            let own = self.squares[k] * self.squares[k] + dark.squares[k] * dark.squares[k];
            self.spread(k).max(dark.spread(k)) * (own - 2.0 * common * common).max(0.0)
        };
        let own = self.parts_with(variance).map(|e| e);
        let other = dark.values();
        let less = |e: Estimate, dark: f64| Estimate::new(e.value - dark, e.standard_uncertainty);
        VarianceComponents {
            total: less(own.total, other.total),
            row: less(own.row, other.row),
            column: less(own.column, other.column),
            pixel: less(own.pixel, other.pixel),
        }
    }

    /// Temporal variance shared by whole rows and by whole columns, DN²: that of their averages beyond σ²/N and σ²/M.
    #[must_use]
    pub fn shared_temporal_dn2(&self) -> (f64, f64) {
        let [pixel, row, column] = self.temporal;
        ((row - pixel / self.columns).max(0.0), (column - pixel / self.rows).max(0.0))
    }

    fn values(&self) -> VarianceComponents<f64> {
        self.parts(self.squares, self.temporal)
    }

    /// Expected temporal part of a mean square.
    fn remainder(&self, k: usize) -> f64 {
        let [pixel, row, column] = self.temporal;
        [row * self.columns, column * self.rows, pixel][k] / self.frames
    }

    fn degrees_of_freedom(&self, k: usize) -> f64 {
        [self.rows - 1.0, self.columns - 1.0, (self.rows - 1.0) * (self.columns - 1.0)][k]
    }

    /// Relative variance of a mean square: Var(mean square) over its square.
    fn spread(&self, k: usize) -> f64 {
        let tails = if k == 2 { self.kurtosis.max(0.0) / (self.rows * self.columns) } else { 0.0 };
        2.0 / self.degrees_of_freedom(k) + tails
    }

    /// The variances from mean squares and temporal variances: linear in both.
    fn parts(&self, squares: [f64; 3], temporal: [f64; 3]) -> VarianceComponents<f64> {
        let (m, n, frames) = (self.rows, self.columns, self.frames);
        let dof: [f64; 3] = core::array::from_fn(|k| self.degrees_of_freedom(k));
        let measured = (0..3).map(|k| dof[k] * squares[k]).sum::<f64>() / (m * n - 1.0);
        let total = measured - temporal[0] / frames;
        let rav = dof[0] / m * squares[0] / n - temporal[1] / frames;
        let cav = dof[1] / n * squares[1] / m - temporal[2] / frames;
        let d = m * n - m - n;
        VarianceComponents {
            total,
            row: ((m * n - n) * rav - m * (total - cav)) / d,
            column: ((m * n - m) * cav - n * (total - rav)) / d,
            pixel: m * n * (total - cav - rav) / d,
        }
    }

    /// The variances, with uncertainties from those of the mean squares and of the temporal variances.
    fn parts_with(&self, variance_of_square: impl Fn(usize) -> f64) -> VarianceComponents<Estimate> {
        let mut sum = VarianceComponents::default();
        let mut add = |slope: VarianceComponents<f64>, variance: f64| {
            let VarianceComponents { total, row, column, pixel } = &mut sum;
            for (sum, slope) in
                [total, row, column, pixel].into_iter().zip([slope.total, slope.row, slope.column, slope.pixel])
            {
                *sum += slope * slope * variance;
            }
        };
        let unit = |k: usize| core::array::from_fn(|i| f64::from(u8::from(i == k)));
        for k in 0..3 {
            add(self.parts(unit(k), [0.0; 3]), variance_of_square(k));
            add(self.parts([0.0; 3], unit(k)), self.variance_of_temporal(k));
        }
        let values = self.values();
        let estimate = |value: f64, variance: f64| Estimate::new(value, variance.sqrt());
        VarianceComponents {
            total: estimate(values.total, sum.total),
            row: estimate(values.row, sum.row),
            column: estimate(values.column, sum.column),
            pixel: estimate(values.pixel, sum.pixel),
        }
    }

    /// χ² with (L − 1) times the number of averages as degrees of freedom.
    fn variance_of_temporal(&self, k: usize) -> f64 {
        let numbers = [self.rows * self.columns, self.rows, self.columns][k];
        2.0 * self.temporal[k] * self.temporal[k] / (numbers * (self.frames - 1.0))
    }
}

/// Row and column averages less the mean.
fn deviations(average: &[f64], width: usize, mean: f64) -> (Vec<f64>, Vec<f64>) {
    let height = average.len() / width;
    let mut columns = vec![0.0; width];
    let mut rows = Vec::with_capacity(height);
    for row in average.chunks_exact(width) {
        rows.push(row.iter().sum::<f64>() / width as f64 - mean);
        columns.iter_mut().zip(row).for_each(|(sum, y)| *sum += y);
    }
    columns.iter_mut().for_each(|sum| *sum = *sum / height as f64 - mean);
    (rows, columns)
}

/// Second and fourth moments of the residual after rows and columns.
struct ResidualMoments {
    second_moment: f64,
    fourth_moment: f64,
}

impl ResidualMoments {
    fn kurtosis(&self) -> f64 {
        if self.second_moment > 0.0 {
            self.fourth_moment / (self.second_moment * self.second_moment) - 3.0
        } else {
            0.0
        }
    }
}

fn residual(average: &[f64], rows: &[f64], columns: &[f64], mean: f64) -> ResidualMoments {
    let (mut second, mut fourth) = (0.0, 0.0);
    for (row, row_deviation) in average.chunks_exact(columns.len()).zip(rows) {
        for (y, column_deviation) in row.iter().zip(columns) {
            let square = (y - mean - row_deviation - column_deviation) * (y - mean - row_deviation - column_deviation);
            second += square;
            fourth += square * square;
        }
    }
    let count = average.len() as f64;
    ResidualMoments { second_moment: second / count, fourth_moment: fourth / count }
}

/// The spectrum along rows (horizontal) of an image stored row by row, DN².
#[must_use]
pub fn horizontal(image: &[f64], width: usize) -> Vec<f64> {
    let mean = image.iter().sum::<f64>() / image.len() as f64;
    spectrum(image.chunks_exact(width).map(|row| row.iter().map(|y| y - mean).collect()), width)
}

/// The spectrum along columns (vertical), DN².
#[must_use]
pub fn vertical(image: &[f64], width: usize) -> Vec<f64> {
    let mean = image.iter().sum::<f64>() / image.len() as f64;
    let column = |x: usize| image.iter().skip(x).step_by(width).map(|y| y - mean).collect();
    spectrum((0..width).map(column), image.len() / width)
}

fn spectrum(lines: impl Iterator<Item = Vec<f64>>, length: usize) -> Vec<f64> {
    let mut sums = vec![0.0; length / 2 + 1];
    let mut count = 0.0;
    for line in lines {
        let transformed = transform(&line.iter().map(|y| [*y, 0.0]).collect::<Vec<_>>());
        for (sum, [re, im]) in sums.iter_mut().zip(&transformed) {
            *sum += re * re + im * im;
        }
        count += 1.0;
    }
    sums.iter().map(|sum| sum / (count * length as f64)).collect()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use etendue_core::maths::f64::cos;

    use super::*;

    #[test]
    fn a_wave_along_rows_is_one_line() {
        let (width, height) = (30, 12);
        let wave = |x: usize| 5.0 + 2.0 * cos(TAU * 4.0 * x as f64 / 30.0);
        let wave_image: Vec<f64> = (0..width * height).map(|i| wave(i % width)).collect();
        let power = horizontal(&wave_image, width);
        // An amplitude of 2 in one of 30 lines: (2/2)² · 30.
        assert!((power[4] - 30.0).abs() < 1e-10, "{power:?}");
        assert!(power.iter().enumerate().all(|(k, p)| k == 4 || p.abs() < 1e-10));
        // Constant along columns: all power is at frequency 0.
        assert!(vertical(&wave_image, width).iter().skip(1).all(|p| p.abs() < 1e-10));
    }
}
