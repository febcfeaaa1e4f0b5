//! Functions of one or two `f64`.
//!
//! `sin`, `cos`, `sin_cos`, `exp` and `ln` are our own, with errors below 1 unit in the last place (largest of 20 000 random arguments against 36 digits: 0.9),
//! and so are `atan` and `atan2`, below 2 (1.6). The others are those of the libm crate (below 1 unit, portable), as no hot path uses them.

use core::f64::consts::{FRAC_2_PI, LOG2_E};

use super::kernel::{
    LN_2_HIGH, LN_2_LOW, circular_series, exponential_series, in_order, inverse_tangent_series, nearest,
    nearest_quarter, out_of_octant, polynomial, power_of_two, split, turned,
};

/// Largest angle reduced here; libm reduces larger ones.
const MAX_REDUCED_ANGLE: f64 = 16_384.0;
/// π/2 in three parts of 39, 39 and 53 bits (Cody & Waite), so that the first two have exact products with the turns
/// of an angle up to [`MAX_REDUCED_ANGLE`].
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_5444_0000),
    f64::from_bits(0x3d86_8c23_4c4c_4000),
    f64::from_bits(0x3b13_145c_06e0_e689),
];

/// Next terms: 8e-20 of the sine, 3e-18 of the cosine, at π/4.
const SIN: [f64; 8] = circular_series(3, -1.0);
const COS: [f64; 7] = circular_series(4, 1.0);
/// Next term: 3e-18 at 1/8.
const ATAN: [f64; 8] = inverse_tangent_series(-1.0);

/// Returns the angle's distance from the nearest quarter turn, as a high and a low part, and the number of that quarter turn.
#[inline]
fn reduced(x: f64) -> (f64, f64, i32) {
    let (turns, quadrant) = nearest(x * FRAC_2_PI);
    let near = x - turns * HALF_PI[0];
    let part = turns * HALF_PI[1];
    let sum = near - part;
    // Knuth's exact error of that difference.
    let back = sum - near;
    let error = (near - (sum - back)) - (part + back);
    let low = turns * HALF_PI[2] - error;
    let r = sum - low;
    (r, (sum - r) - low, quadrant)
}

/// Sine and cosine of `r + low` for |r| ≤ π/4, `low` below the last place of `r`.
#[inline]
fn series(r: f64, low: f64) -> (f64, f64) {
    let z = r * r;
    let sin = r + (r * z * polynomial(z, &SIN) + low * (1.0 - 0.5 * z));
    let half = 0.5 * z;
    let head = 1.0 - half;
    let cos = head + (((1.0 - head) - half) + (z * z * polynomial(z, &COS) - r * low));
    (sin, cos)
}

/// Sine and cosine of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() > MAX_REDUCED_ANGLE || x.is_nan() {
        return libm::sincos(x);
    }
    let (r, low, quadrant) = reduced(x);
    let (sin, cos) = series(r, low);
    let (sin, cos) = turned(sin, cos, quadrant);
    (if x == 0.0 { x } else { sin }, cos)
}

/// Sine of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// Cosine of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// atan(n/d) for 0 ≤ n ≤ d, d neither tiny nor huge: subtracts the nearest quarter and evaluates a series for the remainder.
#[inline]
fn atan_octant(n: f64, d: f64) -> f64 {
    let ((high, low), t) = nearest_quarter(n, d);
    let z = t * t;
    high + (t + (t * z * polynomial(z, &ATAN) + low))
}

/// Returns a power of two that scales a length to a range in which its products neither overflow nor lose bits.
#[inline]
fn rescale(length: f64) -> f64 {
    const HUGE: f64 = f64::from_bits((1023 + 600) << 52);
    const TINY: f64 = f64::from_bits((1023 - 600) << 52);
    if length > HUGE {
        TINY
    } else if length < TINY {
        HUGE
    } else {
        1.0
    }
}

/// The angle of a finite point other than the origin, in the upper half plane.
#[inline]
fn angle(y: f64, x: f64) -> f64 {
    let (ay, ax) = (y.abs(), x.abs());
    let (n, d) = in_order(ay, ax);
    let scale = rescale(d);
    out_of_octant(atan_octant(n * scale, d * scale), ay > ax, x < 0.0)
}

/// The angle of the point (x, y) from the x axis, in −π to π, with the conventions of C for zeros and infinities.
#[must_use]
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    let legal = y.is_finite() && x.is_finite() && y != 0.0;
    if legal { angle(y, x).copysign(y) } else { libm::atan2(y, x) }
}

/// Inverse tangent, in −π/2 to π/2.
#[must_use]
#[inline]
pub fn atan(x: f64) -> f64 {
    if x.is_finite() { angle(x.abs(), 1.0).copysign(x) } else { libm::atan(x) }
}

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
    let (integer, k) = nearest(x * LOG2_E);
    scaled(exp_reduced(x - integer * LN_2_HIGH, integer * LN_2_LOW), k)
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

/// Tangent of an angle in radians.
#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Inverse sine, in −π/2 to π/2; NaN for |x| > 1.
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Inverse cosine, in 0 to π; NaN for |x| > 1.
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// 2 to the power of x; exact for whole numbers.
#[must_use]
pub fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

/// e to the power of x, less one.
#[must_use]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Natural logarithm of 1 + x.
#[must_use]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// Logarithm to base 2.
#[must_use]
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// Logarithm to base 10.
#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// x to the power of y, with the conventions of C for zeros, infinities and negative x.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// Cube root, with the sign of x.
#[must_use]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// √(x² + y²) without overflow; ∞ where either is infinite.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    // Comparison with libm, whose own error is below 1 unit in the last place.

    /// Largest difference of two results, in units in the last place: our bound of 1 and libm's of 1; for angles of points our bound is 2.
    const BOUND: u64 = 2;
    const ANGLE_BOUND: u64 = 3;

    /// Floats of every binade and sign, and the special ones.
    fn everywhere(count: u64) -> impl Iterator<Item = f64> {
        let special = [0.0, 1.0, 0.5, 2.0, 10.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, f64::NAN];
        let patterns = (0..count).map(move |i| f64::from_bits(i * (u64::MAX / count) + i));
        patterns.chain(special).chain(special.map(|x| -x))
    }

    /// `count` floats from `low` to `high`.
    fn between(low: f64, high: f64, count: u32) -> impl Iterator<Item = f64> {
        (0..=count).map(move |i| low + (high - low) * (f64::from(i) / f64::from(count)))
    }

    #[track_caller]
    fn close(actual: f64, exact: f64, bound: u64, x: DVec2) {
        if exact.is_nan() {
            return assert!(actual.is_nan(), "{x:?}: {actual}, not NaN");
        }
        assert_eq!(actual.is_sign_negative(), exact.is_sign_negative(), "{x:?}: {actual} against {exact}");
        let steps = actual.abs().to_bits().abs_diff(exact.abs().to_bits());
        assert!(steps <= bound, "{x:?}: {actual} against {exact}, {steps} units");
    }

    fn compare(f: fn(f64) -> f64, exact: fn(f64) -> f64, arguments: impl Iterator<Item = f64>) {
        arguments.for_each(|x| close(f(x), exact(x), BOUND, DVec2::new(x, 0.0)));
    }

    #[test]
    fn circular_functions() {
        for (f, exact) in [(sin as fn(f64) -> f64, libm::sin as fn(f64) -> f64), (cos, libm::cos)] {
            compare(f, exact, everywhere(300_000));
            compare(f, exact, between(-10.0, 10.0, 300_000));
            compare(f, exact, between(-16_500.0, 16_500.0, 100_000));
            // The hardest angles: next to a multiple of a quarter turn.
            compare(f, exact, (1..10_430).map(|i| f64::from(i) * core::f64::consts::FRAC_PI_2));
        }
        for x in everywhere(10_000) {
            assert_eq!([sin_cos(x).0, sin_cos(x).1].map(f64::to_bits), [sin(x), cos(x)].map(f64::to_bits));
        }
    }

    #[test]
    fn angles_of_points() {
        for x in everywhere(300_000).chain(between(-5.0, 5.0, 300_000)) {
            close(atan(x), libm::atan(x), ANGLE_BOUND, DVec2::new(x, 0.0));
        }
        for y in everywhere(400) {
            everywhere(400).for_each(|x| close(atan2(y, x), libm::atan2(y, x), ANGLE_BOUND, DVec2::new(y, x)));
        }
        for y in between(-2.0, 2.0, 400) {
            between(-2.0, 2.0, 400).for_each(|x| close(atan2(y, x), libm::atan2(y, x), ANGLE_BOUND, DVec2::new(y, x)));
        }
    }

    #[test]
    fn exponentials_and_logarithm() {
        for (f, exact) in [(exp as fn(f64) -> f64, libm::exp as fn(f64) -> f64), (ln, libm::log)] {
            compare(f, exact, everywhere(300_000));
            compare(f, exact, between(-1.5, 3.0, 300_000));
            compare(f, exact, between(-1100.0, 1100.0, 300_000));
        }
        compare(ln, libm::log, between(0.999, 1.001, 100_000));
        assert!((-1074..1024).all(|k| exp2(f64::from(k)) == libm::ldexp(1.0, k)), "powers of two are exact");
    }

    /// Expected values from a calculation to 50 digits (mpmath 1.4.1), correctly rounded.
    #[test]
    fn bits_are_pinned() {
        let actual = [sin(1.0), cos(2.5), atan2(-1.5, -2.5), exp(-4.2), exp2(0.3), ln(7.3)];
        assert_eq!(actual.map(f64::to_bits), PINNED, "changed bits change every picture: is it meant?");
    }

    const PINNED: [u64; 6] = [
        0x3fea_ed54_8f09_0cee,
        0xbfe9_a2f7_ef85_8b7d,
        0xc004_cf33_dec5_e9e0,
        0x3f8e_b600_403a_9684,
        0x3ff3_b2c4_7bff_8329,
        0x3fff_ce55_551e_156e,
    ];
}
