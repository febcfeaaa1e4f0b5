//! Frames of one light level, added one at a time.
//!
//! The sum and the sum of squares of the readings are stored per pixel (16 bytes), independent of the number of frames L; the
//! same for the averages of each row and column. With v the unbiased variance over the L frames of a pixel,
//!
//! ```text
//! σ² = ⟨v⟩ − Var_l(ȳ_l)            EMVA 1288 (release 4.0 linear), temporal variance; for L = 2 it is
//!                                  ⟨(a − b)²⟩/2 − (ā − b̄)²/2
//! ```
//!
//! The second term is the drift of the light, common to all pixels. Uncertainties: that of σ² from the scatter of v over the
//! pixels (no assumption on the noise distribution), that of the mean from σ²/(n L). Both include row and column noise, which
//! averages only over the number of rows or columns: with σ_r² the temporal variance of the averages of M rows, and its shared
//! part ς² = σ_r² − σ²/N,
//!
//! ```text
//! u²(mean) = max(σ²/(M N), σ_r²/M, σ_c²/N)/L        u²(σ²) = Var(v)/(M N) + 2 ς⁴/(M (L − 1)), and likewise for columns
//! ```
//!
//! They exclude the drift of the light.

use std::collections::HashSet;

use super::TransferError;
use crate::{Estimate, Image};

/// Sums over the frames of one level.
#[derive(Clone, Debug)]
pub struct Stack {
    width: usize,
    height: usize,
    frame_means: Vec<f64>,
    sums: PowerSums,
    rows: PowerSums,
    columns: PowerSums,
    /// Fingerprints of frames that are not constant.
    fingerprints: Vec<u64>,
}

/// Σ x and Σ x² of many numbers.
#[derive(Clone, Debug)]
struct PowerSums {
    sum: Vec<f64>,
    sum_of_squares: Vec<f64>,
}

impl PowerSums {
    fn new(count: usize) -> Self {
        Self { sum: vec![0.0; count], sum_of_squares: vec![0.0; count] }
    }

    fn push(&mut self, values: impl IntoIterator<Item = f64>) {
        for ((first, second), value) in self.sum.iter_mut().zip(&mut self.sum_of_squares).zip(values) {
            *first += value;
            *second += value * value;
        }
    }

    /// Adds a constant to all readings of one number; its variance is unchanged.
    fn shift(&mut self, i: usize, change: f64, frames: f64) {
        let (before, after) = (self.sum[i], self.sum[i] + change);
        self.sum[i] = after;
        self.sum_of_squares[i] += (after * after - before * before) / frames;
    }

    /// Unbiased variance of each number over `frames`.
    fn variances(&self, frames: f64) -> impl Iterator<Item = f64> {
        let pairs = self.sum.iter().zip(&self.sum_of_squares);
        pairs.map(move |(first, second)| ((second - first * first / frames) / (frames - 1.0)).max(0.0))
    }

    fn mean_variance(&self, frames: f64) -> f64 {
        self.variances(frames).sum::<f64>() / self.sum.len() as f64
    }
}

/// Temporal statistics of a level's frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelStatistics {
    /// Mean over all pixels and frames, DN.
    pub mean_dn: Estimate,
    /// Temporal variance, averaged over the pixels, DN².
    pub variance_dn2: Estimate,
}

impl Stack {
    /// A stack without frames.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            frame_means: Vec::new(),
            sums: PowerSums::new(width * height),
            rows: PowerSums::new(height),
            columns: PowerSums::new(width),
            fingerprints: Vec::new(),
        }
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If it has another size, contains a reading that is not finite, or equals an earlier frame pixel by pixel (constant frames,
    /// black or saturated, may be equal).
    pub fn push(&mut self, frame: &Image) -> Result<(), TransferError> {
        let (size, expected) = ((frame.width(), frame.height()), (self.width, self.height));
        if size != expected {
            return Err(TransferError::Size { size, expected });
        }
        let samples = frame.samples();
        if samples.iter().any(|s| !s.is_finite()) {
            return Err(TransferError::NotFinite);
        }
        if samples.iter().any(|s| *s != samples[0]) {
            let fingerprint = fingerprint(samples);
            if self.fingerprints.contains(&fingerprint) {
                return Err(TransferError::Copies);
            }
            self.fingerprints.push(fingerprint);
        }
        self.sums.push(samples.iter().map(|s| f64::from(*s)));
        let (rows, columns) = averages(samples, self.width);
        self.frame_means.push(rows.iter().sum::<f64>() / rows.len() as f64);
        self.rows.push(rows);
        self.columns.push(columns);
        Ok(())
    }

    /// Pixels per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frame_means.len()
    }

    /// Mean of each frame, DN.
    #[must_use]
    pub fn frame_means(&self) -> &[f64] {
        &self.frame_means
    }

    /// Fingerprints of the frames that are not constant: equal fingerprints mean equal frames.
    #[must_use]
    pub fn fingerprints(&self) -> &[u64] {
        &self.fingerprints
    }

    /// The averaged frame, DN, row by row.
    #[must_use]
    pub fn average(&self) -> Vec<f64> {
        let frames = self.frames() as f64;
        self.sums.sum.iter().map(|sum| sum / frames).collect()
    }

    /// The stack with the readings at some positions (column, row) replaced by those of the nearest other pixel of the row.
    /// Temporal row, column and frame noise is unchanged; so is a row without another pixel.
    #[must_use]
    pub fn replacing(&self, places: &[[usize; 2]]) -> Self {
        let replaced: HashSet<[usize; 2]> = places.iter().copied().collect();
        let (mut stack, frames) = (self.clone(), self.frames() as f64);
        let mut changed = 0.0;
        for &[x, y] in &replaced {
            let others = (0..self.width).filter(|other| !replaced.contains(&[*other, y]));
            let Some(other) = others.min_by_key(|other| other.abs_diff(x)) else { continue };
            let (at, from) = (y * self.width + x, y * self.width + other);
            let change = self.sums.sum[from] - self.sums.sum[at];
            (stack.sums.sum[at], stack.sums.sum_of_squares[at]) = (self.sums.sum[from], self.sums.sum_of_squares[from]);
            stack.rows.shift(y, change / self.width as f64, frames);
            stack.columns.shift(x, change / self.height as f64, frames);
            changed += change;
        }
        let shift = changed / (frames * (self.width * self.height) as f64);
        stack.frame_means.iter_mut().for_each(|mean| *mean += shift);
        stack
    }

    /// Returns mean and temporal variance.
    ///
    /// # Errors
    /// If there are fewer than two frames, or fewer than two pixels.
    pub fn statistics(&self) -> Result<LevelStatistics, TransferError> {
        let frames = self.at_least_two()?;
        let pixels = self.sums.sum.len() as f64;
        let moments = etendue_stats::Moments::from_values(self.sums.variances(frames));
        let variance = (moments.mean() - self.drift_variance()).max(0.0);
        let u = moments.variance_of_mean().unwrap_or(f64::INFINITY).sqrt();
        let mean = self.frame_means.iter().sum::<f64>() / frames;
        let [_, row, column] = self.temporal()?;
        let (rows, columns) = (self.height as f64, self.width as f64);
        let frame_variance = (variance / pixels).max(row / rows).max(column / columns);
        let shared = |average: f64, others: f64, count: f64| {
            let shared = (average - variance / others).max(0.0);
            2.0 * shared * shared / (count * (frames - 1.0))
        };
        let u = (u * u + shared(row, columns, rows) + shared(column, rows, columns)).sqrt();
        Ok(LevelStatistics {
            mean_dn: Estimate::new(mean, (frame_variance / frames).sqrt()),
            variance_dn2: Estimate::new(variance, u),
        })
    }

    /// Temporal variances, DN², of pixels, of row averages and of column averages, each without the frames' common drift.
    pub(super) fn temporal(&self) -> Result<[f64; 3], TransferError> {
        let (frames, drift) = (self.at_least_two()?, self.drift_variance());
        Ok([&self.sums, &self.rows, &self.columns].map(|sums| (sums.mean_variance(frames) - drift).max(0.0)))
    }

    /// Variance of the frame means over the frames.
    fn drift_variance(&self) -> f64 {
        etendue_stats::Moments::from_values(self.frame_means.iter().copied()).variance().unwrap_or(0.0)
    }

    fn at_least_two(&self) -> Result<f64, TransferError> {
        match self.frames() {
            frames if frames >= 2 && self.width * self.height >= 2 => Ok(frames as f64),
            frames => Err(TransferError::TooFewFrames { frames }),
        }
    }
}

/// Averages of rows and of columns.
fn averages(samples: &[f32], width: usize) -> (Vec<f64>, Vec<f64>) {
    let mut columns = vec![0.0; width];
    let mut rows = Vec::with_capacity(samples.len() / width);
    for row in samples.chunks_exact(width) {
        let mut sum = 0.0;
        for (column, sample) in columns.iter_mut().zip(row) {
            *column += f64::from(*sample);
            sum += f64::from(*sample);
        }
        rows.push(sum / width as f64);
    }
    let height = rows.len() as f64;
    columns.iter_mut().for_each(|column| *column /= height);
    (rows, columns)
}

/// A hash that is equal for equal frames and differs for different ones, except with a probability of 2⁻⁶⁴ (multiply and rotate,
/// after the mixing of Steele, Lea & Flood 2014).
fn fingerprint(samples: &[f32]) -> u64 {
    const ODD: u64 = 0x9e37_79b9_7f4a_7c15;
    samples.iter().fold(samples.len() as u64, |mark, sample| {
        let mixed = (mark ^ u64::from(sample.to_bits())).wrapping_mul(ODD);
        mixed.rotate_left(29) ^ mixed
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: usize, samples: &[f32]) -> Image {
        Image::from_samples(width, samples.len() / width, samples.to_vec()).expect("a rectangle")
    }

    #[test]
    fn two_frames_give_half_the_squared_difference_less_the_drift() {
        let mut stack = Stack::new(2, 2);
        stack.push(&image(2, &[1.0, 2.0, 3.0, 4.0])).expect("a frame");
        stack.push(&image(2, &[2.0, 5.0, 3.0, 8.0])).expect("a frame");
        // Differences 1, 3, 0, 4: ⟨d²⟩/2 = 26/8, mean difference 2.
        let statistics = stack.statistics().expect("two frames");
        assert!((statistics.variance_dn2.value - (3.25 - 2.0)).abs() < 1e-12);
        assert!((statistics.mean_dn.value - 3.5).abs() < 1e-12);
        // d²/2 = 0.5, 4.5, 0, 8: variance of their mean by hand.
        let deviations = [0.5 - 3.25, 4.5 - 3.25, 0.0 - 3.25, 8.0_f64 - 3.25];
        let expected = deviations.iter().map(|d| d * d).sum::<f64>() / 12.0;
        // The part shared by columns is 1.125 − 1.25/2: 2 · 0.5²/2.
        assert!((statistics.variance_dn2.standard_uncertainty - (expected + 0.25).sqrt()).abs() < 1e-12);
    }

    /// Offsets of whole rows: 64 columns give no more information than one.
    #[test]
    fn noise_that_rows_share_averages_over_rows_only() {
        let frame = |jumps: [f32; 4]| image(64, &jumps.map(|jump| [jump; 64]).concat());
        let mut stack = Stack::new(64, 4);
        stack.push(&frame([1.0, -1.0, 2.0, -2.0])).expect("a frame");
        stack.push(&frame([-1.0, 1.0, -2.0, 2.0])).expect("a frame");
        // Variances 2, 2, 8, 8 of the rows: 5 on average, of 4 rows in 2 frames.
        let statistics = stack.statistics().expect("two frames");
        assert!((statistics.mean_dn.standard_uncertainty - (5.0_f64 / 8.0).sqrt()).abs() < 1e-12);
        // The part shared by rows is nearly all of it: 2 · 5²/4, less 5/64 of their averages.
        let shared = 5.0 * (1.0 - 1.0 / 64.0);
        assert!(statistics.variance_dn2.standard_uncertainty > (2.0 * shared * shared / 4.0_f64).sqrt());
    }

    /// As if the frames had been captured with the neighbour's readings there, except for temporal row and column noise.
    #[test]
    fn places_take_the_readings_of_their_neighbours() {
        let frames = [[1.0_f32, 2.0, 3.0, 40.0, 5.0, 7.0], [2.0, 5.0, 3.0, 80.0, 6.0, 6.0]];
        let stack = |frames: &[[f32; 6]; 2]| {
            let mut stack = Stack::new(3, 2);
            frames.iter().for_each(|frame| stack.push(&image(3, frame)).expect("a frame"));
            stack
        };
        let (actual, expected) = (
            stack(&frames).replacing(&[[0, 1]]),
            stack(&frames.map(|mut f| {
                f[3] = f[4];
                f
            })),
        );
        assert_eq!(actual.average(), expected.average());
        assert_eq!(actual.sums.sum_of_squares, expected.sums.sum_of_squares);
        let sums = |stack: &Stack| [stack.rows.sum.clone(), stack.columns.sum.clone()].concat();
        assert!(sums(&actual).iter().zip(sums(&expected)).all(|(a, b)| (a - b).abs() < 1e-12));
        let mean = |stack: &Stack| stack.frame_means.iter().sum::<f64>();
        assert!((mean(&actual) - mean(&expected)).abs() < 1e-12);
        let before = stack(&frames).rows.variances(2.0).collect::<Vec<_>>();
        assert!(actual.rows.variances(2.0).zip(before).all(|(a, b)| (a - b).abs() < 1e-9));
        // A row without another pixel is unchanged.
        assert_eq!(stack(&frames).replacing(&[[0, 0], [1, 0], [2, 0]]).average(), stack(&frames).average());
    }

    #[test]
    fn copies_other_sizes_and_single_frames_are_refused() {
        let frame = image(2, &[1.0, 2.0, 3.0, 4.0]);
        let mut stack = Stack::new(2, 2);
        stack.push(&frame).expect("the first");
        assert_eq!(stack.statistics(), Err(TransferError::TooFewFrames { frames: 1 }));
        assert_eq!(stack.push(&frame), Err(TransferError::Copies));
        assert!(matches!(stack.push(&image(4, &[1.0; 8])), Err(TransferError::Size { .. })));
        assert_eq!(stack.push(&image(2, &[1.0, f32::NAN, 0.0, 0.0])), Err(TransferError::NotFinite));
        // Two saturated frames do not count as copies.
        let mut stack = Stack::new(2, 2);
        let white = image(2, &[255.0; 4]);
        stack.push(&white).and_then(|()| stack.push(&white)).expect("all one value");
    }
}
