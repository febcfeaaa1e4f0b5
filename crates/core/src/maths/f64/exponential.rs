//! The exponential and the natural logarithm.

use super::super::kernel::{
    LN_2_HIGH, LN_2_LOW, exponential_series, inverse_tangent_series, nearest, polynomial, power_of_two, split,
};
use core::f64::consts::LOG2_E;

/// Next term: 4e-18 at half of ln 2.
const EXP: [f64; 12] = exponential_series();
/// Next term: 4e-19 of the sum at (√2 − 1)/(√2 + 1).
const ATANH: [f64; 11] = inverse_tangent_series(1.0);

/// e^(r − low) for |r| ≤ ½ ln 2, `low` far below `r`.
#[inline]
fn exp_reduced(r: f64, low: f64) -> f64 {
    let x = r - low;
    1.0 + (r - (low - x * x * polynomial(x, &EXP)))
}

/// y · 2ᵏ, into the subnormal numbers and to ∞.
#[inline]
fn scaled(y: f64, k: i32) -> f64 {
    if (-1022..=1023).contains(&k) {
        return y * power_of_two(k);
    }
    let half = k >> 1;
    y * power_of_two(half) * power_of_two(k - half)
}

/// e to the power of x.
#[must_use]
#[inline]
pub fn exp(x: f64) -> f64 {
    if x.is_nan() || x.abs() > 750.0 {
        return libm::exp(x);
    }
    let (whole, k) = nearest(x * LOG2_E);
    scaled(exp_reduced(x - whole * LN_2_HIGH, whole * LN_2_LOW), k)
}

/// Natural logarithm; −∞ of zero, NaN of a negative number.
#[must_use]
#[inline]
pub fn ln(x: f64) -> f64 {
    if !(f64::MIN_POSITIVE..f64::INFINITY).contains(&x) {
        return libm::log(x);
    }
    let (k, m) = split(x);
    let k = f64::from(k);
    let f = m - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    // ln(1 + f) = 2 atanh s = 2s + s R, and 2s = f − s f.
    let rest = 2.0 * z * polynomial(z, &ATANH);
    k * LN_2_HIGH + (f - (s * (f - rest) - k * LN_2_LOW))
}
