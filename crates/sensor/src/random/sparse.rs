//! A small fraction of pixels, found without asking each.
//!
//! Each pixel is chosen with probability p, independently. The gaps between chosen pixels of a row are then geometric,
//! P(gap ≥ n) = (1 − p)ⁿ, and are drawn by inversion: ⌊ln u / ln (1 − p)⌋. What is said of a chosen pixel is drawn from the
//! same stream, right after it.

use etendue_core::maths::f64::{ln, ln_1p};
use etendue_core::random::{NoiseKey, NoiseStream, Pixel};

/// The columns of row `y` that a fraction of pixels has, in order, with the stream for what is said of each.
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

/// A number of the exponential distribution of a mean.
pub(crate) fn exponential(mean: f64, stream: &mut NoiseStream) -> f64 {
    -mean * ln(1.0 - stream.unit_f64())
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::NoiseDraw;
    use etendue_stats::chi_square;

    fn chosen(fraction: f64, width: usize, rows: u32) -> Vec<(usize, u32)> {
        let key = NoiseKey::new(9, 0, 0, 0, NoiseDraw::Hot);
        let mut found = Vec::new();
        (0..rows).for_each(|y| each(key, y, fraction, width, |x, _| found.push((x, y))));
        found
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
