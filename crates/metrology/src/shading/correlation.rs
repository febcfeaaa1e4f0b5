//! What noise neighbours share: of a flat field whose pixels are developed, or exchange light.
//!
//! With y/m the readings over the fitted fall-off and C(d) the mean product of their deviations at a distance d, in the middle 256 × 256 pixels,
//!
//! ```text
//! c(d) = C(d) − C_far − [d_x = 0] τ²_columns − [d_y = 0] τ²_rows      |d_x|, |d_y| ≤ 3
//! C_far: mean of C(d) over 4 ≤ max(|d_x|, |d_y|) ≤ 6 off the axes     (light that is uneven over more than some pixels)
//! τ²:    mean of C(d) over 4 … 6 along the column or row, less C_far  (what lines have in common)
//! ```
//!
//! is the noise that neighbours share (zero but at d = 0 where they are independent). A mean over n pixels then has the variance Σ c(d)/n, and the second differences of a row,
//! which tell the noise of a ring, see c(0) − 4/3 c(1, 0) + 1/3 c(2, 0) of it: the ratio of the two is what a ring's variance by second differences is to be
//! multiplied with. White noise of N pixels leaves an error of 13/√N in the ratio (24 distances twice, and what is taken off them); within three times that it is taken for 1.

/// How far noise is shared, and how far what is taken off it is looked for, px.
const REACH: isize = 3;
const FAR: isize = 6;
/// Side of the part that is looked at, px.
const ENOUGH: usize = 256;
/// The error of the ratio by white noise, times the root of the number of pixels; and how many times that is significant.
const ERROR: f64 = 13.0;
const SIGNIFICANT: f64 = 3.0;

/// Noise that neighbours share, of readings over the fall-off.
pub(super) struct Correlation {
    /// c(d), d_x from 0 to [`REACH`], d_y from −[`REACH`] to it, row by row.
    near: Vec<f64>,
}

impl Correlation {
    /// Of readings over their fall-off; `None` where neighbours are independent as far as can be seen.
    pub(super) fn of(relative: &[f64], width: usize) -> Option<Self> {
        let part = Part::middle(relative, width);
        let far = |on_axis: [bool; 2]| part.mean_far(on_axis);
        let uneven = far([false, false]);
        let (columns, rows) = (far([true, false]) - uneven, far([false, true]) - uneven);
        let at = |dx: isize, dy: isize| {
            let lines = if dx == 0 { columns } else { 0.0 } + if dy == 0 { rows } else { 0.0 };
            part.product(dx, dy) - uneven - lines
        };
        let near = (0..=REACH).flat_map(|dx| (-REACH..=REACH).map(move |dy| (dx, dy))).map(|(dx, dy)| at(dx, dy));
        let found = Self { near: near.collect() };
        let error = ERROR / (part.width as f64 * part.height as f64).sqrt();
        let ratio = found.mean_over_differences();
        (ratio > 0.0 && (ratio - 1.0).abs() > SIGNIFICANT * error).then_some(found)
    }

    fn at(&self, dx: isize, dy: isize) -> f64 {
        // Distances of opposite sign are alike.
        let (dx, dy) = if dx < 0 { (-dx, -dy) } else { (dx, dy) };
        self.near[(dx * (2 * REACH + 1) + dy + REACH) as usize]
    }

    /// The variance of a mean of many pixels, times their number.
    fn of_means(&self) -> f64 {
        (-REACH..=REACH).map(|dx| self.of_columns_at(dx)).sum()
    }

    /// Of columns dx apart: the covariance of their means, times their length.
    fn of_columns_at(&self, dx: isize) -> f64 {
        (-REACH..=REACH).map(|dy| self.at(dx, dy)).sum()
    }

    fn of_rows_at(&self, dy: isize) -> f64 {
        (-REACH..=REACH).map(|dx| self.at(dx, dy)).sum()
    }

    /// What the variance by second differences of a row's neighbours is to be multiplied with for that of means.
    pub(super) fn mean_over_differences(&self) -> f64 {
        self.of_means() / seen_by_differences([self.at(0, 0), self.at(1, 0), self.at(2, 0)])
    }

    /// What second differences of the means of neighbouring lines see of it, times their length.
    pub(super) fn of_lines(&self, columns: bool) -> f64 {
        let apart = |d: isize| if columns { self.of_columns_at(d) } else { self.of_rows_at(d) };
        seen_by_differences([apart(0), apart(1), apart(2)])
    }
}

/// A sixth of the mean square of second differences, by the covariances at 0, 1 and 2.
fn seen_by_differences([own, next, second]: [f64; 3]) -> f64 {
    own - 4.0 / 3.0 * next + second / 3.0
}

/// Deviations from the mean in the middle of a picture.
struct Part {
    width: usize,
    height: usize,
    deviations: Vec<f64>,
}

impl Part {
    fn middle(relative: &[f64], width: usize) -> Self {
        let height = relative.len() / width;
        let along = |length: usize| (length.saturating_sub(ENOUGH) / 2, length.min(ENOUGH));
        let ((left, columns), (top, rows)) = (along(width), along(height));
        let row = |y: usize| &relative[(top + y) * width + left..][..columns];
        let mean = (0..rows).map(|y| row(y).iter().sum::<f64>()).sum::<f64>() / (columns * rows) as f64;
        let deviations = (0..rows).flat_map(|y| row(y).iter().map(|v| v - mean)).collect();
        Self { width: columns, height: rows, deviations }
    }

    /// C(d); 0 where the part is not so wide or high.
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
        let all = (0..=FAR).flat_map(|dx| (-FAR..=FAR).map(move |dy| (dx, dy)));
        let far = all.filter(|(dx, dy)| dx.abs().max(dy.abs()) > REACH && (*dx == 0) == column && (*dy == 0) == row);
        let (sum, count) = far.fold((0.0, 0.0), |(sum, count), (dx, dy)| (sum + self.product(dx, dy), count + 1.0));
        sum / count
    }
}
