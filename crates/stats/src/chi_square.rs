//! The χ² distribution, and Pearson's tests of counts.
//!
//! Multiple tests: Šidák's correction (Šidák 1967), exact for independent tests and safe for positively dependent ones.

use etendue_core::maths::f64::{exp_m1, ln_1p};

use crate::special::{gamma_p, gamma_q};

/// Probability of a value below `x`.
#[must_use]
pub fn cdf(x: f64, degrees_of_freedom: f64) -> f64 {
    gamma_p(0.5 * degrees_of_freedom, 0.5 * x)
}

/// Probability of a value above `x`.
#[must_use]
pub fn p_value(x: f64, degrees_of_freedom: f64) -> f64 {
    gamma_q(0.5 * degrees_of_freedom, 0.5 * x)
}

/// The outcome of a χ² test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquareTest {
    /// Pearson's statistic.
    pub statistic: f64,
    pub degrees_of_freedom: usize,
    /// Probability of a statistic this large or larger under the hypothesis.
    pub p: f64,
}

impl ChiSquareTest {
    fn new(statistic: f64, bins: usize) -> Option<Self> {
        let degrees_of_freedom = bins.checked_sub(1).filter(|d| *d > 0)?;
        Some(Self { statistic, degrees_of_freedom, p: p_value(statistic, degrees_of_freedom as f64) })
    }
}

/// Minimum expected count of a pooled bin for χ² to apply (Cochran 1954).
const MIN_EXPECTED: f64 = 5.0;

/// Tests the hypothesis that `observed` counts come from a distribution that expects `expected` counts (same total, no fitted
/// parameters).
///
/// Neighbouring bins are pooled until each expects at least five. A count where nothing is expected makes the statistic infinite.
/// Returns `None` if the slices differ in length, or fewer than two bins remain.
#[must_use]
pub fn goodness_of_fit(observed: &[u64], expected: &[f64]) -> Option<ChiSquareTest> {
    if observed.len() != expected.len() {
        return None;
    }
    if observed.iter().zip(expected).any(|(o, e)| *o > 0 && *e <= 0.0) {
        return ChiSquareTest::new(f64::INFINITY, observed.len());
    }
    let pairs = observed.iter().zip(expected).map(|(o, e)| (*o as f64, *e));
    let bins = pooled(pairs, |bin| bin.1 >= MIN_EXPECTED);
    let statistic = bins.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
    ChiSquareTest::new(statistic, bins.len())
}

/// Tests the hypothesis that two samples, counted in the same bins, come from one distribution.
///
/// Neighbouring bins are pooled until each sample expects at least five. Returns `None` if the slices differ in length, a sample
/// is empty, or fewer than two bins remain.
#[must_use]
pub fn same_distribution(a: &[u64], b: &[u64]) -> Option<ChiSquareTest> {
    let (total_a, total_b) = (a.iter().sum::<u64>() as f64, b.iter().sum::<u64>() as f64);
    if a.len() != b.len() || total_a == 0.0 || total_b == 0.0 {
        return None;
    }
    let smaller_share = total_a.min(total_b) / (total_a + total_b);
    let pairs = a.iter().zip(b).map(|(x, y)| (*x as f64, *y as f64));
    let bins = pooled(pairs, |bin| (bin.0 + bin.1) * smaller_share >= MIN_EXPECTED);
    let (k_a, k_b) = ((total_b / total_a).sqrt(), (total_a / total_b).sqrt());
    let statistic = bins.iter().map(|(x, y)| (k_a * x - k_b * y) * (k_a * x - k_b * y) / (x + y)).sum();
    ChiSquareTest::new(statistic, bins.len())
}

/// Pools neighbours until `enough`; the remainder at the end joins the last bin.
fn pooled(pairs: impl Iterator<Item = (f64, f64)>, enough: impl Fn((f64, f64)) -> bool) -> Vec<(f64, f64)> {
    let mut bins: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for pair in pairs {
        open = (open.0 + pair.0, open.1 + pair.1);
        if enough(open) {
            bins.push(core::mem::take(&mut open));
        }
    }
    if let Some(last) = bins.last_mut() {
        *last = (last.0 + open.0, last.1 + open.1);
    }
    bins
}

/// Level of each of `tests` tests at which the whole family is wrong with probability `significance`: 1 − (1 − α)^(1/n). For no
/// tests it is `significance`.
#[must_use]
pub fn sidak_level(significance: f64, tests: usize) -> f64 {
    -exp_m1(ln_1p(-significance) / tests.max(1) as f64)
}

/// p-value of the family, from its smallest single one: 1 − (1 − p)ⁿ. For no tests it is 1.
#[must_use]
pub fn sidak_p(smallest_p: f64, tests: usize) -> f64 {
    if tests == 0 { 1.0 } else { -exp_m1(ln_1p(-smallest_p) * tests as f64) }
}

#[cfg(test)]
mod tests {
    use etendue_core::maths::f64::exp;

    use super::*;

    #[test]
    fn two_degrees_are_an_exponential() {
        for x in [0.0, 0.1, 2.0, 30.0, 700.0] {
            assert!((p_value(x, 2.0) / exp(-0.5 * x) - 1.0).abs() < 1e-12);
            assert!((cdf(x, 2.0) + p_value(x, 2.0) - 1.0).abs() < 1e-15);
        }
        // Tables: χ² of 10 degrees at 5 % is 18.307.
        assert!((p_value(18.307, 10.0) - 0.05).abs() < 1e-5);
    }

    #[test]
    fn pearson_by_hand() {
        // (8 − 10)²/10 + (12 − 10)²/10 + (10 − 10)²/10 = 0.8, p = e^-0.4.
        let test = goodness_of_fit(&[8, 12, 10], &[10.0, 10.0, 10.0]).expect("three bins");
        assert!((test.statistic - 0.8).abs() < 1e-12 && test.degrees_of_freedom == 2);
        assert!((test.p - exp(-0.4)).abs() < 1e-12);
        let same = same_distribution(&[10, 20, 30], &[20, 40, 60]).expect("three bins");
        assert!(same.statistic.abs() < 1e-12 && same.p > 0.999);
        let other = same_distribution(&[100, 0, 50], &[0, 100, 50]).expect("three bins");
        assert!((other.statistic - 200.0).abs() < 1e-9);
    }

    #[test]
    fn small_bins_are_pooled_and_the_impossible_is_seen() {
        let test = goodness_of_fit(&[2, 4, 9, 1], &[3.0, 3.0, 9.0, 1.0]).expect("two bins");
        assert_eq!(test.degrees_of_freedom, 1);
        assert_eq!(goodness_of_fit(&[5, 5, 1], &[5.0, 6.0, 0.0]).expect("a refusal").p, 0.0);
        assert!(goodness_of_fit(&[5], &[5.0]).is_none() && goodness_of_fit(&[5, 5], &[5.0]).is_none());
        assert!(same_distribution(&[0, 0], &[1, 2]).is_none());
    }

    #[test]
    fn level_and_p_are_inverse_and_keep_small_digits() {
        for n in [1, 2, 1000, 100_000_000] {
            assert!((sidak_p(sidak_level(0.01, n), n) / 0.01 - 1.0).abs() < 1e-12);
        }
        // −ln(1 − α)/n to first order in 1/n; the next term is 5e-9 of it.
        assert!((sidak_level(0.01, 1_000_000) / 1.005_033_585_35e-8 - 1.0).abs() < 6e-9);
        assert_eq!((sidak_p(1.0, 5), sidak_p(0.3, 0), sidak_p(0.0, 9)), (1.0, 1.0, 0.0));
    }
}
