//! The standard normal distribution.

use core::f64::consts::{FRAC_1_SQRT_2, PI};

use etendue_core::maths::f64::{exp, ln};

use crate::special::erfc;

/// Density at `z`.
#[must_use]
pub fn pdf(z: f64) -> f64 {
    exp(-0.5 * z * z) / (2.0 * PI).sqrt()
}

/// Probability of a value below `z`. Relative error below 1e-13, in the lower tail too.
#[must_use]
pub fn cdf(z: f64) -> f64 {
    0.5 * erfc(-z * FRAC_1_SQRT_2)
}

/// Probability of a value farther from zero than |z|.
#[must_use]
pub fn two_sided_p(z: f64) -> f64 {
    erfc(z.abs() * FRAC_1_SQRT_2)
}

/// Quantile: the value with a fraction `p` of the distribution below it; ∓∞ at 0 and 1, NaN outside.
///
/// Halley's iteration on [`cdf`] from the two-constant start of Abramowitz and Stegun 26.2.22. Relative error below 1e-12 for `p`
/// from 1e-300 to 1/2; above 1/2 it is that of 1 − p.
#[must_use]
pub fn quantile(p: f64) -> f64 {
    match p {
        0.0 => f64::NEG_INFINITY,
        1.0 => f64::INFINITY,
        0.5 => 0.0,
        p if p > 0.0 && p < 0.5 => lower_quantile(p),
        p if p > 0.5 && p < 1.0 => -lower_quantile(1.0 - p),
        _ => f64::NAN,
    }
}

fn lower_quantile(p: f64) -> f64 {
    let t = (-2.0 * ln(p)).sqrt();
    let mut z = (2.30753 + 0.27061 * t) / (1.0 + t * (0.99229 + 0.04481 * t)) - t;
    for _ in 0..6 {
        let error = (cdf(z) - p) / pdf(z);
        let step = error / (1.0 + 0.5 * z * error);
        z -= step;
        if step.abs() <= 1e-15 * z.abs() {
            break;
        }
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        assert!((cdf(1.959_963_984_540_054) - 0.975).abs() < 1e-15);
        assert!((cdf(-6.0) / 9.865_876_450_376_946e-10 - 1.0).abs() < 1e-12);
        assert!((two_sided_p(-3.0) / 2.699_796_063_260_189e-3 - 1.0).abs() < 1e-13);
        assert!((quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
        assert!((quantile(1e-10) / -6.361_340_902_404_056 - 1.0).abs() < 1e-12);
        assert_eq!(quantile(0.5), 0.0);
        assert_eq!((quantile(0.0), quantile(1.0)), (f64::NEG_INFINITY, f64::INFINITY));
        assert!(quantile(-0.1).is_nan() && quantile(f64::NAN).is_nan());
    }

    #[test]
    fn the_quantile_is_the_inverse() {
        for exponent in 1..300 {
            let p = exp(-2.3 * f64::from(exponent));
            assert!((cdf(quantile(p)) / p - 1.0).abs() < 1e-10, "{p:e}");
        }
    }
}
