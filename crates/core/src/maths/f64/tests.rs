//! Against libm, whose own error is below 1 unit in the last place.

use super::*;

/// Steps that two results may lie apart: our bound of 1 unit and libm's of 1; for angles of points ours is 2.
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
fn close(got: f64, exact: f64, bound: u64, x: (f64, f64)) {
    if exact.is_nan() {
        return assert!(got.is_nan(), "{x:?}: {got}, not NaN");
    }
    assert_eq!(got.is_sign_negative(), exact.is_sign_negative(), "{x:?}: {got} against {exact}");
    let steps = got.abs().to_bits().abs_diff(exact.abs().to_bits());
    assert!(steps <= bound, "{x:?}: {got} against {exact}, {steps} units");
}

fn compare(f: fn(f64) -> f64, exact: fn(f64) -> f64, arguments: impl Iterator<Item = f64>) {
    arguments.for_each(|x| close(f(x), exact(x), BOUND, (x, 0.0)));
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
        close(atan(x), libm::atan(x), ANGLE_BOUND, (x, 0.0));
    }
    for y in everywhere(400) {
        everywhere(400).for_each(|x| close(atan2(y, x), libm::atan2(y, x), ANGLE_BOUND, (y, x)));
    }
    for y in between(-2.0, 2.0, 400) {
        between(-2.0, 2.0, 400).for_each(|x| close(atan2(y, x), libm::atan2(y, x), ANGLE_BOUND, (y, x)));
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

/// Figures of a calculation to 50 digits (mpmath 1.4.1), correctly rounded.
#[test]
fn bits_are_pinned() {
    let got = [sin(1.0), cos(2.5), atan2(-1.5, -2.5), exp(-4.2), exp2(0.3), ln(7.3)];
    assert_eq!(got.map(f64::to_bits), PINNED, "changed bits change every picture: is it meant?");
}

const PINNED: [u64; 6] = [
    0x3fea_ed54_8f09_0cee,
    0xbfe9_a2f7_ef85_8b7d,
    0xc004_cf33_dec5_e9e0,
    0x3f8e_b600_403a_9684,
    0x3ff3_b2c4_7bff_8329,
    0x3fff_ce55_551e_156e,
];
