//! Noise shared by neighbours, in a flat field whose pixels are developed or have crosstalk.
//!
//! With y/m the readings over the fitted fall-off and C(d) the mean product of their deviations at a distance d, in the middle
//! 256 × 256 pixels,
//!
//! ```text
//! c(d) = C(d) − C_far − [d_x = 0] τ²_columns − [d_y = 0] τ²_rows      |d_x|, |d_y| ≤ 3
//! C_far: mean of C(d) over 4 ≤ max(|d_x|, |d_y|) ≤ 6 off the axes     (light that varies slowly over the pixels)
//! τ²:    mean of C(d) over 4 … 6 along the column or row, less C_far  (row and column noise)
//! ```
//!
//! is the noise shared by neighbours (zero except at d = 0 if they are independent). A mean over n pixels then has the variance Σ
//! c(d)/n. The second differences of a row, which measure the noise of a ring, see c(0) − 4/3 c(1, 0) + 1/3 c(2, 0). A ring's
//! variance from second differences is multiplied by the ratio of the two. White noise of N pixels leaves an error of 13/√N in
//! the ratio (24 distances twice, and the subtracted terms); within three times that the ratio is set to 1.

/// Reach of shared noise, and of the subtracted terms, px.
const REACH: isize = 3;
const REFERENCE_PX: isize = 6;
/// Side of the evaluated part, px.
const MAX_SIDE_PX: usize = 256;
/// Error of the ratio from white noise, times the square root of the number of pixels; and its multiple that is significant.
const WHITE_NOISE_ERROR: f64 = 13.0;
const MIN_SIGNIFICANCE: f64 = 3.0;

/// Noise shared by neighbours, of readings relative to the fall-off.
pub(super) struct Correlation {
    /// c(d), d_x from 0 to [`REACH`], d_y from −[`REACH`] to it, row by row.
    near: Vec<f64>,
}

impl Correlation {
    /// Estimates it from readings relative to their fall-off; `None` if neighbours show no significant correlation.
    pub(super) fn from_relative(relative: &[f64], width: usize) -> Option<Self> {
        let part = CentralDeviations::middle(relative, width);
        let far = |on_axis: [bool; 2]| part.mean_far(on_axis);
        let uneven = far([false, false]);
        let (columns, rows) = (far([true, false]) - uneven, far([false, true]) - uneven);
        let at = |dx: isize, dy: isize| {
            let lines = if dx == 0 { columns } else { 0.0 } + if dy == 0 { rows } else { 0.0 };
            part.product(dx, dy) - uneven - lines
        };
        let near = (0..=REACH).flat_map(|dx| (-REACH..=REACH).map(move |dy| (dx, dy))).map(|(dx, dy)| at(dx, dy));
        let correlation = Self { near: near.collect() };
        let error = WHITE_NOISE_ERROR / (part.width as f64 * part.height as f64).sqrt();
        let ratio = correlation.mean_over_differences();
        (ratio > 0.0 && (ratio - 1.0).abs() > MIN_SIGNIFICANCE * error).then_some(correlation)
    }

    fn at(&self, dx: isize, dy: isize) -> f64 {
        // C(d) is equal at opposite distances.
        let (dx, dy) = if dx < 0 { (-dx, -dy) } else { (dx, dy) };
        self.near[(dx * (2 * REACH + 1) + dy + REACH) as usize]
    }

    /// The variance of a mean of many pixels, times the number of pixels.
    fn mean_variance(&self) -> f64 {
        (-REACH..=REACH).map(|dx| self.column_covariance(dx)).sum()
    }

    /// Covariance of the means of columns dx apart, times their length.
    fn column_covariance(&self, dx: isize) -> f64 {
        (-REACH..=REACH).map(|dy| self.at(dx, dy)).sum()
    }

    fn row_covariance(&self, dy: isize) -> f64 {
        (-REACH..=REACH).map(|dx| self.at(dx, dy)).sum()
    }

    /// Factor from the variance by second differences of a row's neighbours to that of means.
    pub(super) fn mean_over_differences(&self) -> f64 {
        self.mean_variance() / second_difference_variance([self.at(0, 0), self.at(1, 0), self.at(2, 0)])
    }

    /// Its contribution to second differences of the means of neighbouring lines, times their length.
    pub(super) fn line_differences(&self, columns: bool) -> f64 {
        let covariance = |d: isize| if columns { self.column_covariance(d) } else { self.row_covariance(d) };
        second_difference_variance([covariance(0), covariance(1), covariance(2)])
    }
}

/// A sixth of the mean square of second differences, from the covariances at 0, 1 and 2.
fn second_difference_variance([own, next, second]: [f64; 3]) -> f64 {
    own - 4.0 / 3.0 * next + second / 3.0
}

/// Deviations from the mean in the centre of an image.
struct CentralDeviations {
    width: usize,
    height: usize,
    deviations: Vec<f64>,
}

impl CentralDeviations {
    fn middle(relative: &[f64], width: usize) -> Self {
        let height = relative.len() / width;
        let along = |length: usize| (length.saturating_sub(MAX_SIDE_PX) / 2, length.min(MAX_SIDE_PX));
        let ((left, columns), (top, rows)) = (along(width), along(height));
        let row = |y: usize| &relative[(top + y) * width + left..][..columns];
        let mean = (0..rows).map(|y| row(y).iter().sum::<f64>()).sum::<f64>() / (columns * rows) as f64;
        let deviations = (0..rows).flat_map(|y| row(y).iter().map(|v| v - mean)).collect();
        Self { width: columns, height: rows, deviations }
    }

    /// C(d); 0 if the part is too small.
    fn product(&self, dx: isize, dy: isize) -> f64 {
        let (right, down, up) = (dx.unsigned_abs(), dy.max(0).unsigned_abs(), dy.min(0).unsigned_abs());
        let (columns, rows) = (self.width.saturating_sub(right), self.height.saturating_sub(down + up));
        let (from, to) = if dx < 0 { (right, 0) } else { (0, right) };
        let row = |y: usize| {
            let (a, b) = ((y + up) * self.width + from, (y + down) * self.width + to);
            let pairs = self.deviations[a..a + columns].iter().zip(&self.deviations[b..b + columns]);
            pairs.map(|(p, q)| p * q).sum::<f64>()
        };
        (0..rows).map(row).sum::<f64>() / (columns * rows).max(1) as f64
    }

    /// Mean of C(d) beyond the reach, along a column (d_x = 0), along a row (d_y = 0), or off both.
    fn mean_far(&self, [column, row]: [bool; 2]) -> f64 {
        let all = (0..=REFERENCE_PX).flat_map(|dx| (-REFERENCE_PX..=REFERENCE_PX).map(move |dy| (dx, dy)));
        let far = all.filter(|(dx, dy)| dx.abs().max(dy.abs()) > REACH && (*dx == 0) == column && (*dy == 0) == row);
        let (sum, count) = far.fold((0.0, 0.0), |(sum, count), (dx, dy)| (sum + self.product(dx, dy), count + 1.0));
        sum / count
    }
}
