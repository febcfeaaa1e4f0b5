//! Student's t distribution, of any positive (not only whole) number of degrees of freedom.

use crate::special::beta_i;

/// Probability of a value below `t`.
#[must_use]
pub fn cdf(t: f64, degrees_of_freedom: f64) -> f64 {
    let tail = 0.5 * two_sided_p(t, degrees_of_freedom);
    if t < 0.0 { tail } else { 1.0 - tail }
}

/// Probability of a value farther from zero than |t|: I(ν/(ν + t²); ν/2, 1/2). For an infinite `t` it is 0.
#[must_use]
pub fn two_sided_p(t: f64, degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom == f64::INFINITY {
        return crate::normal::two_sided_p(t);
    }
    if t.is_infinite() {
        return 0.0;
    }
    let (nu, square) = (degrees_of_freedom, t * t);
    if square < nu {
        // I_x(a, b) = 1 − I_{1−x}(b, a): a small argument keeps its precision.
        1.0 - beta_i(0.5, 0.5 * nu, square / (nu + square))
    } else {
        beta_i(0.5 * nu, 0.5, nu / (nu + square))
    }
}

/// The |t| that is exceeded with the two-sided probability `p` in (0, 1); NaN outside.
///
/// By bisection on [`two_sided_p`], to the last bits.
#[must_use]
pub fn critical(p: f64, degrees_of_freedom: f64) -> f64 {
    if !(p > 0.0 && p < 1.0 && degrees_of_freedom > 0.0) {
        return f64::NAN;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while two_sided_p(high, degrees_of_freedom) > p && high < 1e150 {
        low = high;
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if two_sided_p(middle, degrees_of_freedom) > p {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use etendue_core::maths::f64::atan;

    #[test]
    fn one_and_two_degrees_have_closed_forms() {
        for t in [0.1, 0.7, 1.0, 3.0, 40.0, 1e4] {
            // 1 − 2/π·atan t loses digits in Cauchy's tail; the equivalent atan(1/t) does not.
            assert!((two_sided_p(t, 1.0) / (2.0 / PI * atan(1.0 / t)) - 1.0).abs() < 1e-12, "{t}");
            let root = (2.0 + t * t).sqrt();
            assert!((two_sided_p(t, 2.0) / (2.0 / (root * (root + t))) - 1.0).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn critical_values_are_those_of_the_tables() {
        // Tables to three decimals.
        for (p, nu, expected) in [(0.05, 1.0, 12.706), (0.05, 4.0, 2.776), (0.01, 10.0, 3.169), (0.001, 30.0, 3.646)] {
            assert!((critical(p, nu) - expected).abs() < 5.1e-4, "{p} {nu}: {}", critical(p, nu));
        }
        assert!((critical(0.05, f64::INFINITY) - 1.959_963_984_540_054).abs() < 1e-12);
        assert!((critical(1e-9, 7.0) - critical(1e-9, 7.0)).abs() < f64::EPSILON);
        assert!((two_sided_p(critical(1e-9, 7.0), 7.0) / 1e-9 - 1.0).abs() < 1e-9);
        assert!(critical(0.0, 3.0).is_nan() && critical(0.5, 0.0).is_nan());
    }

    #[test]
    fn the_two_tails_mirror() {
        assert!((cdf(1.3, 5.0) + cdf(-1.3, 5.0) - 1.0).abs() < 1e-15);
        assert!((cdf(0.0, 5.0) - 0.5).abs() < 1e-15);
        assert_eq!(two_sided_p(f64::INFINITY, 3.0), 0.0);
    }
}
