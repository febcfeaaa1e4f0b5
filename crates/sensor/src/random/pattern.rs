//! Normal deviations with a white, a row and a column part.
//!
//! d(x, y) = σ_w z(x, y) + σ_r z(y) + σ_c z(x), z standard normal and independent (EMVA 1288 release 4 splits non-uniformity in
//! the same three parts). A part of zero draws nothing.

use super::standard_normal;
use etendue_core::random::{NoiseDraw, NoiseKey, Pixel};

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
    /// The parts that there are, in words: `pixels by 0.01, rows by 0.002`, each with its unit.
    pub(crate) fn described(self, unit: &str) -> String {
        let parts = [("pixels", self.white), ("rows", self.row), ("columns", self.column)];
        let stated = parts.into_iter().filter(|(_, sigma)| *sigma > 0.0);
        stated.map(|(name, sigma)| format!("{name} by {sigma}{unit}")).collect::<Vec<_>>().join(", ")
    }
}

/// Draws of the three parts: of a pixel, of a row (at column 0), of a column (at row 0).
pub(crate) type Draws = [NoiseDraw; 3];

/// Deviations of an array, prepared.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Deviations {
    white: Option<(f64, NoiseKey)>,
    row: Option<(f64, NoiseKey)>,
    /// Empty where there is no column part.
    columns: Vec<f64>,
}

impl Deviations {
    pub(crate) fn new(sigmas: Sigmas, draws: Draws, key: impl Fn(NoiseDraw) -> NoiseKey, width: usize) -> Self {
        let [white, row, column] = draws.map(key);
        let part = |sigma: f64, key| (sigma > 0.0).then_some((sigma, key));
        let columns = match part(sigmas.column, column) {
            None => Vec::new(),
            Some((sigma, key)) => (0..width).map(|x| sigma * normal(key, x as u32, 0)).collect(),
        };
        Self { white: part(sigmas.white, white), row: part(sigmas.row, row), columns }
    }

    /// The deviations of row `y`, each given to `take` with its column.
    pub(crate) fn of_row(&self, y: u32, width: usize, mut take: impl FnMut(usize, f64)) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_stats::Moments;

    #[test]
    fn the_three_parts_have_their_own_variance() {
        let key = |draw| NoiseKey::new(3, 0, 0, 0, draw);
        let draws = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let sigmas = Sigmas { white: 3.0, row: 2.0, column: 1.0 };
        let n = 512;
        let pattern = Deviations::new(sigmas, draws, key, n);
        let mut d = vec![vec![0.0; n]; n];
        (0..n).for_each(|y| pattern.of_row(y as u32, n, |x, value| d[y][x] = value));
        let row_means: Vec<f64> = d.iter().map(|row| row.iter().sum::<f64>() / n as f64).collect();
        let column_means: Vec<f64> = (0..n).map(|x| d.iter().map(|row| row[x]).sum::<f64>() / n as f64).collect();
        let variance = |values: &[f64]| Moments::of(values.iter().copied()).variance().expect("many");
        // A mean over n pixels keeps σ_w²/n and, common to all, the mean of the other part. A variance of n normal numbers is
        // known to √(2/n) = 6.3 %; four of those.
        assert!((variance(&row_means) / (4.0 + 9.0 / 512.0) - 1.0).abs() < 0.25);
        assert!((variance(&column_means) / (1.0 + 9.0 / 512.0) - 1.0).abs() < 0.25);
        let mean = row_means.iter().sum::<f64>() / n as f64;
        let rest = (0..n * n).map(|i| d[i / n][i % n] - row_means[i / n] - column_means[i % n] + mean);
        // √(2/n²) = 0.28 %.
        assert!((Moments::of(rest).variance().expect("many") / 9.0 - 1.0).abs() < 0.0112 + 2.0 / 512.0);
    }

    #[test]
    fn parts_of_zero_are_zero() {
        let key = |draw| NoiseKey::new(3, 0, 0, 0, draw);
        let draws = [NoiseDraw::PixelOffset, NoiseDraw::RowOffset, NoiseDraw::ColumnOffset];
        let pattern = Deviations::new(Sigmas { column: 1.0, ..Sigmas::default() }, draws, key, 8);
        let mut rows = [[0.0; 8]; 2];
        (0..2).for_each(|y| pattern.of_row(y, 8, |x, value| rows[y as usize][x] = value));
        assert_eq!(rows[0], rows[1]);
        assert!(rows[0][0] != rows[0][1]);
    }
}
