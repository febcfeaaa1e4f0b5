//! Functions of one or two `f32`.
//!
//! Series in double precision, rounded once: the error is at most 0.51 units in the last place, over the whole range
//! and into the subnormal numbers.

#[cfg(test)]
mod tests;

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, LN_2, LOG2_E, LOG10_E};

use super::kernel::{
    circular_series, exponential_series, in_order, inverse_tangent_series, nearest, nearest_quarter, out_of_octant,
    polynomial, power_of_two, split, turned,
};

/// Calls a function of libm for arguments that our own series do not cover; kept out of line for the ordinary arguments.
#[cold]
#[inline(never)]
fn special(f: impl Fn(f64) -> f64, x: f32) -> f32 {
    f(f64::from(x)) as f32
}

/// Largest angle reduced here; libm reduces larger ones.
const MAX_REDUCED_ANGLE: f32 = 1.0e6;
/// π/2 to 33 bits, so that its products with the turns of an angle up to [`MAX_REDUCED_ANGLE`] are exact.
const HALF_PI_HIGH: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
/// Low part of π/2.
const HALF_PI_LOW: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

/// Next terms: 7e-12 of the sine, 2e-12 of the cosine, at π/4.
const SIN: [f64; 5] = circular_series(3, -1.0);
const COS: [f64; 5] = circular_series(4, 1.0);
/// Next term: 9e-11 at 1/8.
const ATAN: [f64; 4] = inverse_tangent_series(-1.0);
/// (asin √z / √z − 1)/z for z of 0 to 1/4, fitted at the Chebyshev points: error 6e-11 of the inverse sine.
const ASIN: [f64; 7] = [
    0.166_666_666_860_856_43,
    0.074_999_924_044_018_38,
    0.044_647_663_888_134_85,
    0.030_269_138_728_589_183,
    0.023_611_817_008_891_752,
    0.010_574_415_516_912_909,
    0.030_974_540_371_355_073,
];

/// Sine and cosine in double precision.
#[inline]
fn sin_cos_wide(x: f32) -> (f64, f64) {
    let x = f64::from(x);
    let (turns, quadrant) = nearest(x * FRAC_2_PI);
    let r = (x - turns * HALF_PI_HIGH) - turns * HALF_PI_LOW;
    let z = r * r;
    let sin = r + r * z * polynomial(z, &SIN);
    let cos = 1.0 - 0.5 * z + z * z * polynomial(z, &COS);
    turned(sin, cos, quadrant)
}

/// Returns true if an angle is within the range of the reduction.
#[inline]
fn moderate(x: f32) -> bool {
    x.abs() <= MAX_REDUCED_ANGLE
}

/// Sine of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn sin(x: f32) -> f32 {
    sin_cos(x).0
}

/// Cosine of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn cos(x: f32) -> f32 {
    sin_cos(x).1
}

/// Sine and cosine of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    if !moderate(x) {
        return (special(libm::sin, x), special(libm::cos, x));
    }
    let (sin, cos) = sin_cos_wide(x);
    (if x == 0.0 { x } else { sin as f32 }, cos as f32)
}

/// Tangent of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn tan(x: f32) -> f32 {
    if !moderate(x) {
        return special(libm::tan, x);
    }
    let (sin, cos) = sin_cos_wide(x);
    if x == 0.0 { x } else { (sin / cos) as f32 }
}

/// atan(n/d) for 0 ≤ n ≤ d, d > 0: subtracts the nearest quarter and evaluates a series for the remainder.
#[inline]
fn atan_octant(n: f64, d: f64) -> f64 {
    let ((quarter, _), t) = nearest_quarter(n, d);
    let z = t * t;
    quarter + (t + t * z * polynomial(z, &ATAN))
}

/// Angle of a finite point other than the origin, in double precision. Ignores the sign of zeros.
#[inline]
fn angle_wide(y: f64, x: f64) -> f64 {
    let (ay, ax) = (y.abs(), x.abs());
    let (n, d) = in_order(ay, ax);
    out_of_octant(atan_octant(n, d), ay > ax, x < 0.0)
}

/// The angle of the point (x, y) from the x axis, in −π to π, with the conventions of C for zeros and infinities.
#[must_use]
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    let legal = y.is_finite() && x.is_finite() && y != 0.0;
    if legal {
        (angle_wide(f64::from(y), f64::from(x)) as f32).copysign(y)
    } else {
        special(|x| libm::atan2(f64::from(y), x), x)
    }
}

/// Inverse tangent, in −π/2 to π/2.
#[must_use]
#[inline]
pub fn atan(x: f32) -> f32 {
    if x.is_finite() { (angle_wide(f64::from(x).abs(), 1.0) as f32).copysign(x) } else { special(libm::atan, x) }
}

/// Inverse sine of a number of 0 to 1, in double precision: the fit itself up to 1/2, π/2 − 2 asin √((1 − x)/2) above.
#[inline]
fn asin_wide(x: f64) -> f64 {
    let small = x <= 0.5;
    let z = if small { x * x } else { 0.5 * (1.0 - x) };
    let s = if small { x } else { z.sqrt() };
    let fit = s + s * z * polynomial(z, &ASIN);
    if small { fit } else { FRAC_PI_2 - 2.0 * fit }
}

/// Inverse sine, in −π/2 to π/2; NaN for |x| > 1.
#[must_use]
#[inline]
pub fn asin(x: f32) -> f32 {
    let wide = f64::from(x).abs();
    if wide <= 1.0 { (asin_wide(wide) as f32).copysign(x) } else { f32::NAN }
}

/// Inverse cosine, in 0 to π; NaN for |x| > 1.
#[must_use]
#[inline]
pub fn acos(x: f32) -> f32 {
    let wide = f64::from(x);
    let upper = asin_wide(wide.abs());
    if wide.abs() <= 1.0 { (FRAC_PI_2 - upper.copysign(wide)) as f32 } else { f32::NAN }
}

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
    let (integer, k) = nearest(x);
    let scale = power_of_two(k);
    scale + scale * exp_m1_reduced((x - integer) * LN_2)
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
    let (integer, k) = nearest(x * LOG2_E);
    let scale = power_of_two(k);
    ((scale - 1.0) + scale * exp_m1_reduced(x - integer * LN_2)) as f32
}

/// Returns true if the logarithm is finite and the argument normal.
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
