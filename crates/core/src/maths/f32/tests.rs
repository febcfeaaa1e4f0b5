use super::*;
use glam::Vec2;

// Comparison with libm in double precision, whose own error (below 1e-8 units of an `f32`) is negligible.

/// Bound stated by the module, in units in the last place.
const BOUND_ULP: f64 = 0.51;

/// Floats of every binade and sign: every `step`-th bit pattern, and the special ones.
fn everywhere(step: usize) -> impl Iterator<Item = f32> {
    let special = [0.0, 1.0, 0.5, 2.0, 10.0, 1000.0, 1e-45, f32::MIN_POSITIVE, f32::MAX, f32::INFINITY, f32::NAN];
    let patterns = (0..=u32::MAX).step_by(step).map(f32::from_bits);
    patterns.chain(special).chain(special.map(|x| -x))
}

/// `count` floats from `low` to `high`, both included.
fn between(low: f32, high: f32, count: u32) -> impl Iterator<Item = f32> {
    (0..=count).map(move |i| low + (high - low) * (i as f32 / count as f32))
}

fn unit_in_last_place(exact: f64) -> f64 {
    let near = (exact.abs() as f32).clamp(f32::MIN_POSITIVE, f32::MAX);
    let binade = f32::from_bits(near.to_bits() & 0x7f80_0000);
    f64::from(binade) * f64::from(f32::EPSILON)
}

#[track_caller]
fn close(actual: f32, exact: f64, x: Vec2) {
    if exact.is_nan() {
        return assert!(actual.is_nan(), "{x:?}: {actual}, not NaN");
    }
    let rounded = exact as f32;
    if actual == rounded {
        return assert!(
            actual != 0.0 || actual.is_sign_negative() == exact.is_sign_negative(),
            "{x:?}: sign of {actual}"
        );
    }
    let error = (f64::from(actual) - exact).abs() / unit_in_last_place(exact);
    assert!(error <= BOUND_ULP, "{x:?}: {actual} against {exact}, {error} units");
}

fn compare(f: fn(f32) -> f32, exact: fn(f64) -> f64, arguments: impl Iterator<Item = f32>) {
    arguments.for_each(|x| close(f(x), exact(f64::from(x)), Vec2::new(x, 0.0)));
}

const STEP: usize = 9973;

#[test]
fn circular_functions() {
    for (f, exact) in [(sin as fn(f32) -> f32, libm::sin as fn(f64) -> f64), (cos, libm::cos), (tan, libm::tan)] {
        compare(f, exact, everywhere(STEP));
        compare(f, exact, between(-10.0, 10.0, 200_000));
        compare(f, exact, (0..20_000).map(|i| (f64::from(i) * core::f64::consts::FRAC_PI_2) as f32));
    }
    for x in everywhere(STEP) {
        assert_eq!(sin_cos(x).0.to_bits(), sin(x).to_bits());
        assert_eq!(sin_cos(x).1.to_bits(), cos(x).to_bits());
    }
}

#[test]
fn inverse_circular_functions() {
    for (f, exact) in [(asin as fn(f32) -> f32, libm::asin as fn(f64) -> f64), (acos, libm::acos), (atan, libm::atan)] {
        compare(f, exact, everywhere(STEP));
        compare(f, exact, between(-1.0, 1.0, 200_000));
    }
    for y in everywhere(5_000_011) {
        everywhere(5_000_011).for_each(|x| close(atan2(y, x), libm::atan2(y.into(), x.into()), Vec2::new(y, x)));
    }
    for y in between(-2.0, 2.0, 400) {
        between(-2.0, 2.0, 400).for_each(|x| close(atan2(y, x), libm::atan2(y.into(), x.into()), Vec2::new(y, x)));
    }
}

#[test]
fn exponentials_and_logarithms() {
    type Pair = (fn(f32) -> f32, fn(f64) -> f64);
    let pairs: [Pair; 8] = [
        (exp, libm::exp),
        (exp2, libm::exp2),
        (exp_m1, libm::expm1),
        (ln, libm::log),
        (ln_1p, libm::log1p),
        (log2, libm::log2),
        (log10, libm::log10),
        (cbrt, libm::cbrt),
    ];
    for (f, exact) in pairs {
        compare(f, exact, everywhere(STEP));
        compare(f, exact, between(-1.5, 3.0, 200_000));
        compare(f, exact, between(-150.0, 150.0, 200_000));
    }
}

#[test]
fn powers_and_lengths() {
    for x in everywhere(5_000_011) {
        for y in everywhere(5_000_011) {
            close(hypot(x, y), libm::hypot(x.into(), y.into()), Vec2::new(x, y));
        }
        for y in between(-3.0, 3.0, 96).chain([0.0, -0.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e30, -1e30]) {
            close(pow(x, y), libm::pow(x.into(), y.into()), Vec2::new(x, y));
        }
    }
    for x in between(0.0, 2.0, 1000) {
        between(-20.0, 20.0, 200).for_each(|y| close(pow(x, y), libm::pow(x.into(), y.into()), Vec2::new(x, y)));
    }
}

/// Expected values from a calculation to 50 digits (mpmath 1.4.1), correctly rounded.
#[test]
fn bits_are_pinned() {
    let actual = [
        sin(1.0),
        cos(2.5),
        tan(-0.7),
        asin(0.3),
        acos(-0.9),
        atan2(-3.0, -2.0),
        exp(-4.2),
        exp2(0.3),
        exp_m1(1e-3),
        ln(7.3),
        ln_1p(-0.4),
        log2(3.0),
        log10(5.0),
        pow(0.18, 2.4),
        cbrt(-11.0),
        hypot(1.1, -2.3),
    ];
    assert_eq!(actual.map(f32::to_bits), PINNED, "changed bits change every picture: is it meant?");
}

const PINNED: [u32; 16] = [
    0x3f57_6aa4,
    0xbf4d_17bf,
    0xbf57_a036,
    0x3e9c_00ad,
    0x402c_323b,
    0xc00a_29c3,
    0x3c75_b005,
    0x3f9d_9624,
    0x3a83_2337,
    0x3ffe_72ab,
    0xbf02_c578,
    0x3fca_e00d,
    0x3f32_efb3,
    0x3c85_ac4e,
    0xc00e_55b1,
    0x4023_2b2b,
];
