//! Many tests at once: Šidák's correction (Šidák 1967), exact for independent tests and safe for positively
//! dependent ones.

use etendue_core::maths::f64::{exp_m1, ln_1p};

/// The level of each of `tests` tests at which the whole family is wrong with probability `significance`:
/// 1 − (1 − α)^(1/n). Of no test at all it is `significance`.
#[must_use]
pub fn sidak_level(significance: f64, tests: usize) -> f64 {
    -exp_m1(ln_1p(-significance) / tests.max(1) as f64)
}

/// The family's p-value, from its smallest single one: 1 − (1 − p)ⁿ. Of no test at all it is 1.
#[must_use]
pub fn sidak_p(smallest_p: f64, tests: usize) -> f64 {
    if tests == 0 { 1.0 } else { -exp_m1(ln_1p(-smallest_p) * tests as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;

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
