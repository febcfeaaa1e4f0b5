//! Building blocks of both precisions: polynomials, series, powers of two.

use core::f64::consts::{FRAC_PI_2, PI};

/// ln 2 to 32 bits, so that its products with exponents are exact.
pub(super) const LN_2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
/// Low part of ln 2.
pub(super) const LN_2_LOW: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);

/// atan(i/4), high and low parts.
const ATAN_QUARTERS: [(f64, f64); 5] = [
    (0.0, 0.0),
    (f64::from_bits(0x3fcf_5b75_f92c_80dd), f64::from_bits(0x3c68_ab6e_3cf7_afbd)),
    (f64::from_bits(0x3fdd_ac67_0561_bb4f), f64::from_bits(0x3c7a_2b7f_222f_65e2)),
    (f64::from_bits(0x3fe4_978f_a326_9ee1), f64::from_bits(0x3c72_419a_87f2_a458)),
    (f64::from_bits(0x3fe9_21fb_5444_2d18), f64::from_bits(0x3c81_a626_3314_5c07)),
];

/// 1.5 · 2⁵²: added to a small number, it leaves the nearest whole number in the low bits.
const TO_WHOLE: f64 = 6_755_399_441_055_744.0;

/// The whole number nearest to `x` (even at halves), |x| < 2³¹, as a float and as an integer.
#[inline(always)]
pub(super) fn nearest(x: f64) -> (f64, i32) {
    let shifted = x + TO_WHOLE;
    (shifted - TO_WHOLE, shifted.to_bits() as i32)
}

/// The arctangent of the multiple of 1/4 nearest to n/d, as a high and a low part, and the tangent of the remaining angle; 0 ≤ n ≤ d, d > 0.
#[inline(always)]
pub(super) fn nearest_quarter(n: f64, d: f64) -> ((f64, f64), f64) {
    let (quarters, i) = nearest(4.0 * (n / d));
    let c = 0.25 * quarters;
    (ATAN_QUARTERS[(i as usize).min(4)], (n - c * d) / (d + c * n))
}

/// 2ᵏ for −1022 ≤ k ≤ 1023.
#[inline(always)]
pub(super) fn power_of_two(k: i32) -> f64 {
    f64::from_bits((i64::from(k) + 1023).cast_unsigned() << 52)
}

/// A positive, normal number as 2ᵏ · m with m in [√½, √2).
#[inline(always)]
pub(super) fn split(x: f64) -> (i32, f64) {
    const SQRT_HALF: i64 = 0x3fe6_a09e_667f_3bcd;
    let bits = x.to_bits().cast_signed();
    let k = (bits - SQRT_HALF) >> 52;
    (k as i32, f64::from_bits((bits - (k << 52)).cast_unsigned()))
}

/// Cosine and sine of zero, one, two and three quarter turns.
const QUARTER_TURNS: [(f64, f64); 4] = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];

/// Sine and cosine of an angle increased by `quadrant` quarter turns. Uses an exact rotation: a branch on a random quadrant would cost more than everything
/// else.
#[inline(always)]
pub(super) fn turned(sin: f64, cos: f64, quadrant: i32) -> (f64, f64) {
    let (c, s) = QUARTER_TURNS[(quadrant & 3) as usize];
    (c * sin + s * cos, c * cos - s * sin)
}

/// Angle (high part, low part) at which an octant of the upper half plane starts or ends, and the sign of the octant's own angle: by |y| > |x| (1) and x < 0
/// (2).
const OCTANTS: [(f64, f64, f64); 4] = [
    (0.0, 0.0, 1.0),
    (FRAC_PI_2, f64::from_bits(0x3c91_a626_3314_5c07), -1.0),
    (PI, f64::from_bits(0x3ca1_a626_3314_5c07), -1.0),
    (FRAC_PI_2, f64::from_bits(0x3c91_a626_3314_5c07), 1.0),
];

/// Angle of a point in the upper half plane from that of its octant, 0 to π/4; `steep` is |y| > |x|. Uses a table, for the same reason as [`turned`].
#[inline(always)]
pub(super) fn out_of_octant(octant: f64, steep: bool, behind: bool) -> f64 {
    let (high, low, sign) = OCTANTS[usize::from(steep) | usize::from(behind) << 1];
    high + (sign * octant + low)
}

/// The smaller and the larger of two ordinary numbers.
#[inline(always)]
pub(super) fn in_order(a: f64, b: f64) -> (f64, f64) {
    (if a < b { a } else { b }, if a < b { b } else { a })
}

/// c₀ + c₁ x + c₂ x² + …, even and odd terms separately, each by Horner's rule.
#[inline(always)]
pub(super) fn polynomial<const N: usize>(x: f64, c: &[f64; N]) -> f64 {
    let square = x * x;
    let (mut even, mut odd) = (0.0, 0.0);
    for i in (0..N).rev() {
        let sum = if i % 2 == 0 { &mut even } else { &mut odd };
        *sum = if i + 2 >= N { c[i] } else { *sum * square + c[i] };
    }
    even + x * odd
}

/// Coefficients of (eˣ − 1 − x)/x² : 1/2!, 1/3!, …
pub(super) const fn exponential_series<const N: usize>() -> [f64; N] {
    let mut c = [0.0; N];
    let mut i = 0;
    while i < N {
        c[i] = 1.0 / factorial(i + 2);
        i += 1;
    }
    c
}

/// Coefficients of (sin √z / √z − 1)/z (`first` = 3) or (cos √z − 1 + z/2)/z² (`first` = 4), which starts with `sign`.
pub(super) const fn circular_series<const N: usize>(first: usize, sign: f64) -> [f64; N] {
    let mut c = [0.0; N];
    let mut i = 0;
    while i < N {
        c[i] = (if i % 2 == 0 { sign } else { -sign }) / factorial(first + 2 * i);
        i += 1;
    }
    c
}

/// Coefficients of (atanh √z / √z − 1)/z (`sign` = 1) or of the same of atan (`sign` = −1): ±1/3, 1/5, ±1/7 …
pub(super) const fn inverse_tangent_series<const N: usize>(sign: f64) -> [f64; N] {
    let mut c = [0.0; N];
    let mut i = 0;
    while i < N {
        c[i] = (if i % 2 == 0 { sign } else { 1.0 }) / (2 * i + 3) as f64;
        i += 1;
    }
    c
}

const fn factorial(n: usize) -> f64 {
    let mut product = 1.0;
    let mut i = 2;
    while i <= n {
        product *= i as f64;
        i += 1;
    }
    product
}
