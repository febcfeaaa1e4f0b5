//! Sine, cosine and the angle of a point.

use super::super::kernel::{
    ATAN_QUARTERS, circular_series, in_order, inverse_tangent_series, nearest, out_of_octant, polynomial, turned,
};
use core::f64::consts::FRAC_2_PI;

/// Beyond it, angles are reduced by libm.
const LARGEST: f64 = 16_384.0;
/// π/2 in three parts of 39, 39 and 53 bits (Cody & Waite), so that the first two have exact products with the turns
/// of an angle up to [`LARGEST`].
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

/// The angle's distance from the nearest quarter turn, high and low part, and the number of that quarter turn.
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
    if x.abs() > LARGEST || x.is_nan() {
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

/// atan(n/d) for 0 ≤ n ≤ d, d neither tiny nor huge: the nearest quarter is taken off, a series has the rest.
#[inline]
fn atan_octant(n: f64, d: f64) -> f64 {
    let (quarters, i) = nearest(4.0 * (n / d));
    let c = 0.25 * quarters;
    let t = (n - c * d) / (d + c * n);
    let z = t * t;
    let (high, low) = ATAN_QUARTERS[(i as usize).min(4)];
    high + (t + (t * z * polynomial(z, &ATAN) + low))
}

/// A power of two that brings a length to where its products neither overflow nor lose bits.
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
