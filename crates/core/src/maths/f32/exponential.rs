//! Exponentials, logarithms and powers.

use super::super::kernel::{exponential_series, inverse_tangent_series, nearest, polynomial, power_of_two, split};
use super::special;
use core::f64::consts::{LN_2, LOG2_E, LOG10_E};

/// Next term: 3e-11 at half of ln 2.
const EXP: [f64; 8] = exponential_series();
/// Next term: 2e-15 at (√2 − 1)/(√2 + 1).
const ATANH: [f64; 8] = inverse_tangent_series(1.0);

/// e^r − 1 for |r| ≤ ½ ln 2.
#[inline]
fn exp_m1_reduced(r: f64) -> f64 {
    r + r * r * polynomial(r, &EXP)
}

/// 2^x in double precision, for |x| ≤ 1000.
#[inline]
fn exp2_wide(x: f64) -> f64 {
    let (whole, k) = nearest(x);
    let scale = power_of_two(k);
    scale + scale * exp_m1_reduced((x - whole) * LN_2)
}

/// e to the power of x.
#[must_use]
#[inline]
pub fn exp(x: f32) -> f32 {
    if x.abs() <= 200.0 { exp2_wide(f64::from(x) * LOG2_E) as f32 } else { special(libm::exp, x) }
}

/// 2 to the power of x.
#[must_use]
#[inline]
pub fn exp2(x: f32) -> f32 {
    if x.abs() <= 300.0 { exp2_wide(f64::from(x)) as f32 } else { special(libm::exp2, x) }
}

/// e to the power of x, less one: exact to the last place near zero.
#[must_use]
#[inline]
pub fn exp_m1(x: f32) -> f32 {
    if x == 0.0 || x.is_nan() || x.abs() > 200.0 {
        return special(libm::expm1, x);
    }
    let x = f64::from(x);
    let (whole, k) = nearest(x * LOG2_E);
    let scale = power_of_two(k);
    ((scale - 1.0) + scale * exp_m1_reduced(x - whole * LN_2)) as f32
}

/// Whether a logarithm is an ordinary number.
#[inline]
fn has_logarithm(x: f32) -> bool {
    x > 0.0 && x < f32::INFINITY
}

/// ln(1 + f) for 1 + f in [√½, √2): 2 atanh(f/(2 + f)).
#[inline]
fn ln_1p_reduced(f: f64) -> f64 {
    let s = f / (2.0 + f);
    let z = s * s;
    2.0 * (s + s * z * polynomial(z, &ATANH))
}

/// Natural logarithm in double precision.
#[inline]
fn ln_wide(x: f64) -> f64 {
    let (k, m) = split(x);
    f64::from(k) * LN_2 + ln_1p_reduced(m - 1.0)
}

/// Logarithm to base 2 in double precision.
#[inline]
fn log2_wide(x: f64) -> f64 {
    let (k, m) = split(x);
    f64::from(k) + ln_1p_reduced(m - 1.0) * LOG2_E
}

/// Natural logarithm; −∞ of zero, NaN of a negative number.
#[must_use]
#[inline]
pub fn ln(x: f32) -> f32 {
    if has_logarithm(x) { ln_wide(f64::from(x)) as f32 } else { special(libm::log, x) }
}

/// Natural logarithm of 1 + x: exact to the last place near zero.
#[must_use]
#[inline]
pub fn ln_1p(x: f32) -> f32 {
    if x == 0.0 || !has_logarithm(1.0 + x) {
        return special(libm::log1p, x);
    }
    let x = f64::from(x);
    if x.abs() < 0.25 { ln_1p_reduced(x) as f32 } else { ln_wide(1.0 + x) as f32 }
}

/// Logarithm to base 2; exact for powers of two.
#[must_use]
#[inline]
pub fn log2(x: f32) -> f32 {
    if has_logarithm(x) { log2_wide(f64::from(x)) as f32 } else { special(libm::log2, x) }
}

/// Logarithm to base 10; exact for powers of ten.
#[must_use]
#[inline]
pub fn log10(x: f32) -> f32 {
    if has_logarithm(x) { (ln_wide(f64::from(x)) * LOG10_E) as f32 } else { special(libm::log10, x) }
}

/// x to the power of y, with the conventions of C for zeros, infinities and negative x.
#[must_use]
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    if !has_logarithm(x) || !y.is_finite() {
        return special(|x| libm::pow(x, f64::from(y)), x);
    }
    exp2_wide((f64::from(y) * log2_wide(f64::from(x))).clamp(-400.0, 400.0)) as f32
}

/// Cube root, with the sign of x.
#[must_use]
#[inline]
pub fn cbrt(x: f32) -> f32 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let wide = f64::from(x).abs();
    // A third of the exponent, within 6 %; each step of Halley's method cubes the error.
    let start = f64::from_bits(wide.to_bits() / 3 + 0x2a9f_7893_0000_0000);
    let root = halley_cbrt(halley_cbrt(start, wide), wide);
    (root as f32).copysign(x)
}

/// A step of Halley's method towards the cube root of `x`.
#[inline]
fn halley_cbrt(t: f64, x: f64) -> f64 {
    let cube = t * t * t;
    t * (cube + 2.0 * x) / (2.0 * cube + x)
}

/// √(x² + y²) without overflow; ∞ where either is infinite.
#[must_use]
#[inline]
pub fn hypot(x: f32, y: f32) -> f32 {
    if x.is_infinite() || y.is_infinite() {
        return f32::INFINITY;
    }
    let (x, y) = (f64::from(x), f64::from(y));
    (x * x + y * y).sqrt() as f32
}
