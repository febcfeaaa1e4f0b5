//! Circular functions and their inverses.

use super::super::kernel::{ATAN_QUARTERS, circular_series, inverse_tangent_series, nearest, polynomial};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

/// Beyond it, angles are reduced by libm.
const LARGEST: f32 = 1.0e6;
/// π/2 to 33 bits, so that its products with the turns of an angle up to [`LARGEST`] are exact.
const HALF_PI_HIGH: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
/// The rest of π/2.
const HALF_PI_LOW: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

/// Next terms: 7e-12 of the sine, 2e-12 of the cosine, at π/4.
const SIN: [f64; 5] = circular_series(3, -1.0);
const COS: [f64; 5] = circular_series(4, 1.0);
/// Next term: 9e-11 at 1/8.
const ATAN: [f64; 4] = inverse_tangent_series(-1.0);

/// Sine and cosine in double precision.
#[inline]
fn sin_cos_wide(x: f32) -> (f64, f64) {
    let x = f64::from(x);
    let (turns, quadrant) = nearest(x * FRAC_2_PI);
    let r = (x - turns * HALF_PI_HIGH) - turns * HALF_PI_LOW;
    let z = r * r;
    let sin = r + r * z * polynomial(z, &SIN);
    let cos = 1.0 - 0.5 * z + z * z * polynomial(z, &COS);
    let (sin, cos) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, sin) };
    (if quadrant & 2 == 0 { sin } else { -sin }, if (quadrant + 1) & 2 == 0 { cos } else { -cos })
}

/// Whether an angle is within the range of the reduction.
#[inline]
fn moderate(x: f32) -> bool {
    x.abs() <= LARGEST
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
        return rounded(libm::sincos(f64::from(x)));
    }
    let (sin, cos) = rounded(sin_cos_wide(x));
    (if x == 0.0 { x } else { sin }, cos)
}

#[inline]
fn rounded((a, b): (f64, f64)) -> (f32, f32) {
    (a as f32, b as f32)
}

/// Tangent of an angle in radians. NaN for ±∞.
#[must_use]
#[inline]
pub fn tan(x: f32) -> f32 {
    if !moderate(x) {
        return libm::tan(f64::from(x)) as f32;
    }
    let (sin, cos) = sin_cos_wide(x);
    if x == 0.0 { x } else { (sin / cos) as f32 }
}

/// atan(n/d) for 0 ≤ n ≤ d, d > 0: the nearest quarter is taken off, a series has the rest.
#[inline]
fn atan_octant(n: f64, d: f64) -> f64 {
    let (quarters, i) = nearest(4.0 * (n / d));
    let c = 0.25 * quarters;
    let t = (n - c * d) / (d + c * n);
    let z = t * t;
    ATAN_QUARTERS[(i as usize).min(4)].0 + (t + t * z * polynomial(z, &ATAN))
}

/// The angle of a finite point other than the origin, in double precision; the sign of a zero is not kept.
#[inline]
fn angle_wide(y: f64, x: f64) -> f64 {
    let (ay, ax) = (y.abs(), x.abs());
    let octant = atan_octant(ay.min(ax), ay.max(ax));
    let first = if ay > ax { FRAC_PI_2 - octant } else { octant };
    if x < 0.0 { PI - first } else { first }
}

/// The angle of the point (x, y) from the x axis, in −π to π, with the conventions of C for zeros and infinities.
#[must_use]
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    let legal = y.is_finite() && x.is_finite() && y != 0.0;
    if legal {
        (angle_wide(f64::from(y), f64::from(x)) as f32).copysign(y)
    } else {
        libm::atan2(f64::from(y), f64::from(x)) as f32
    }
}

/// Inverse tangent, in −π/2 to π/2.
#[must_use]
#[inline]
pub fn atan(x: f32) -> f32 {
    if x.is_finite() {
        (angle_wide(f64::from(x).abs(), 1.0) as f32).copysign(x)
    } else {
        libm::atan(f64::from(x)) as f32
    }
}

/// √(1 − x²), NaN for |x| > 1.
#[inline]
fn complement(x: f64) -> f64 {
    ((1.0 - x) * (1.0 + x)).sqrt()
}

/// Inverse sine, in −π/2 to π/2; NaN for |x| > 1.
#[must_use]
#[inline]
pub fn asin(x: f32) -> f32 {
    let wide = f64::from(x).abs();
    if wide <= 1.0 { (angle_wide(wide, complement(wide)) as f32).copysign(x) } else { f32::NAN }
}

/// Inverse cosine, in 0 to π; NaN for |x| > 1.
#[must_use]
#[inline]
pub fn acos(x: f32) -> f32 {
    let wide = f64::from(x);
    if wide.abs() <= 1.0 { angle_wide(complement(wide), wide) as f32 } else { f32::NAN }
}
