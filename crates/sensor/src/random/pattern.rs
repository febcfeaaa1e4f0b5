//! Normal deviations with a white, a row and a column part.
//!
//! d(x, y) = σ_w z(x, y) + σ_r z(y) + σ_c z(x), z standard normal and independent (EMVA 1288 release 4 splits non-uniformity into the same three
//! parts). A zero part uses no random numbers.
//!
//! A small fraction of pixels, selected without testing each pixel.
//!
//! Each pixel is selected with probability p, independently. The gaps between selected pixels of a row are then geometric, P(gap ≥ n) = (1 − p)ⁿ, and
//! are sampled by inversion: ⌊ln u / ln (1 − p)⌋. The properties of a selected pixel come from the same stream, directly after it.

use etendue_core::maths::f64::{ln, ln_1p};
use etendue_core::random::{NoiseDraw, NoiseKey, NoiseStream, Pixel};

use super::standard_normal;

/// Standard deviations of the three parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sigmas {
    pub(crate) white: f64,
    pub(crate) row: f64,
    pub(crate) column: f64,
}

impl Sigmas {
    pub(crate) fn is_zero(self) -> bool {
        self.white == 0.0 && self.row == 0.0 && self.column == 0.0
    }
}

impl Sigmas {
    /// The non-zero parts in words: `pixels by 0.01, rows by 0.002`, each with its unit.
    pub(crate) fn described(self, unit: &str) -> String {
        let parts = [("pixels", self.white), ("rows", self.row), ("columns", self.column)];
        let nonzero = parts.into_iter().filter(|(_, sigma)| *sigma > 0.0);
        nonzero.map(|(name, sigma)| format!("{name} {sigma}{unit}")).collect::<Vec<_>>().join(", ")
    }
}

/// Random numbers of the three parts: of a pixel, of a row (at column 0), of a column (at row 0).
pub(crate) type PartPurposes = [NoiseDraw; 3];

/// Deviations of an array, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Deviations {
    white: Option<(f64, NoiseKey)>,
    row: Option<(f64, NoiseKey)>,
    /// Empty if there is no column part.
    columns: Vec<f64>,
}

impl Deviations {
    pub(crate) fn new(
        sigmas: Sigmas,
        purposes: PartPurposes,
        key: impl Fn(NoiseDraw) -> NoiseKey,
        width: usize,
    ) -> Self {
        let [white, row, column] = purposes.map(key);
        let part = |sigma: f64, key| (sigma > 0.0).then_some((sigma, key));
        let columns = match part(sigmas.column, column) {
            None => Vec::new(),
            Some((sigma, key)) => (0..width).map(|x| sigma * normal(key, x as u32, 0)).collect(),
        };
        Self { white: part(sigmas.white, white), row: part(sigmas.row, row), columns }
    }

    /// Calls `take` with the column and deviation of each pixel of row `y`.
    pub(crate) fn for_row(&self, y: u32, width: usize, mut take: impl FnMut(usize, f64)) {
        let row = self.row.map_or(0.0, |(sigma, key)| sigma * normal(key, 0, y));
        for x in 0..width {
            let shared = row + self.columns.get(x).copied().unwrap_or(0.0);
            let white = self.white.map_or(0.0, |(sigma, key)| sigma * normal(key, x as u32, y));
            take(x, shared + white);
        }
    }
}

fn normal(key: NoiseKey, x: u32, y: u32) -> f64 {
    standard_normal(&mut key.stream(Pixel { x, y }))
}

/// Visits the selected columns of row `y` in order, with the stream for the properties of each.
pub(crate) fn each(key: NoiseKey, y: u32, fraction: f64, width: usize, mut take: impl FnMut(usize, &mut NoiseStream)) {
    let mut stream = key.stream(Pixel { x: 0, y });
    let mut x = 0;
    loop {
        x = after_gap(x, fraction, width, &mut stream);
        if x >= width {
            return;
        }
        take(x, &mut stream);
        x += 1;
    }
}

fn after_gap(x: usize, fraction: f64, width: usize, stream: &mut NoiseStream) -> usize {
    if fraction >= 1.0 {
        return x;
    }
    let gap = (ln(1.0 - stream.unit_f64()) / ln_1p(-fraction)).floor();
    if gap < (width - x) as f64 { x + gap as usize } else { width }
}

/// A sample of the exponential distribution of a mean.
pub(crate) fn exponential(mean: f64, stream: &mut NoiseStream) -> f64 {
    -mean * ln(1.0 - stream.unit_f64())
}

#[cfg(test)]
mod tests {
    use etendue_core::random::NoiseDraw;
    use etendue_stats::{Moments, chi_square};

    use super::*;

    #[test]
    fn the_three_parts_have_their_own_variance() {
        let key = |purpose| NoiseKey::new(3, 0, 0, 0, purpose);
        let purposes = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let sigmas = Sigmas { white: 3.0, row: 2.0, column: 1.0 };
        let n = 512;
        let pattern = Deviations::new(sigmas, purposes, key, n);
        let mut d = vec![vec![0.0; n]; n];
        (0..n).for_each(|y| pattern.for_row(y as u32, n, |x, value| d[y][x] = value));
        let row_means: Vec<f64> = d.iter().map(|row| row.iter().sum::<f64>() / n as f64).collect();
        let column_means: Vec<f64> = (0..n).map(|x| d.iter().map(|row| row[x]).sum::<f64>() / n as f64).collect();
        let variance = |values: &[f64]| Moments::from_values(values.iter().copied()).variance().expect("many");
        // A mean over n pixels keeps σ_w²/n and, common to all, the mean of the other part. A variance of n normal numbers is known to √(2/n) = 6.3
        // %; tolerance: four of those.
        assert!((variance(&row_means) / (4.0 + 9.0 / 512.0) - 1.0).abs() < 0.25);
        assert!((variance(&column_means) / (1.0 + 9.0 / 512.0) - 1.0).abs() < 0.25);
        let mean = row_means.iter().sum::<f64>() / n as f64;
        let rest = (0..n * n).map(|i| d[i / n][i % n] - row_means[i / n] - column_means[i % n] + mean);
        // √(2/n²) = 0.28 %.
        assert!((Moments::from_values(rest).variance().expect("many") / 9.0 - 1.0).abs() < 0.0112 + 2.0 / 512.0);
    }

    #[test]
    fn parts_of_zero_are_zero() {
        let key = |purpose| NoiseKey::new(3, 0, 0, 0, purpose);
        let purposes = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let pattern = Deviations::new(Sigmas { column: 1.0, ..Sigmas::default() }, purposes, key, 8);
        let mut rows = [[0.0; 8]; 2];
        (0..2).for_each(|y| pattern.for_row(y, 8, |x, value| rows[y as usize][x] = value));
        assert_eq!(rows[0], rows[1]);
        assert!(rows[0][0] != rows[0][1]);
    }

    fn chosen(fraction: f64, width: usize, rows: u32) -> Vec<(usize, u32)> {
        let key = NoiseKey::new(9, 0, 0, 0, NoiseDraw::Hot);
        let mut columns = Vec::new();
        (0..rows).for_each(|y| each(key, y, fraction, width, |x, _| columns.push((x, y))));
        columns
    }

    #[test]
    fn every_column_is_as_likely_as_the_others() {
        for fraction in [0.02, 0.5] {
            let mut counts = [0_u64; 40];
            chosen(fraction, 40, 20_000).iter().for_each(|(x, _)| counts[*x] += 1);
            // A column's count is binomial: its variance is (1 − p) of the Poisson one that χ² takes.
            let statistic: f64 = counts.iter().map(|n| *n as f64 - 20_000.0 * fraction).map(|d| d * d).sum::<f64>()
                / (20_000.0 * fraction * (1.0 - fraction));
            let p = chi_square::p_value(statistic, 40.0);
            assert!(p > 1e-3 && p < 1.0 - 1e-3, "{fraction}: {p}");
        }
    }

    #[test]
    fn all_and_none() {
        assert_eq!(chosen(1.0, 5, 2).len(), 10);
        assert_eq!(chosen(1e-12, 1000, 100).len(), 0);
    }

    #[test]
    fn amplitudes_are_exponential() {
        let mut stream = NoiseKey::new(1, 0, 0, 0, NoiseDraw::Hot).stream(Pixel { x: 0, y: 0 });
        let n = 100_000;
        let mean = (0..n).map(|_| exponential(2.0, &mut stream)).sum::<f64>() / f64::from(n);
        assert!((mean / 2.0 - 1.0).abs() < 4.0 / f64::from(n).sqrt());
    }
}
