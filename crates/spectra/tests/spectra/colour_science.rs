//! Comparison with colour-science: reference values of `tests/oracles/colour.py`.
//!
//! The script puts its tables on the same grid of 1 nm, linear between points, so the remaining difference is this crate's storage in single
//! precision: 6e-8 per value, less in sums.

use etendue_spectra::colour::{Lab, ciede2000, lab};
use etendue_spectra::{Spectrum, illuminant, observer, reflectance};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/colour.json");
const SINGLE: f64 = 1.2e-7;

fn figures() -> Value {
    serde_json::from_str(FIGURES).expect("the figures are JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn triple(value: &Value) -> [f64; 3] {
    core::array::from_fn(|i| number(&value[i]))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

#[track_caller]
fn close(actual: [f64; 3], expected: [f64; 3], tolerance: f64, what: &str) {
    let worst = (0..3).map(|c| (actual[c] - expected[c]).abs()).fold(0.0, f64::max);
    assert!(worst <= tolerance, "{what}: {actual:?} against {expected:?}");
}

#[test]
fn white_points_of_illuminants() {
    let figures = figures();
    let illuminants = figures["illuminants"].as_object().expect("an object");
    assert_eq!(illuminants.len(), 8);
    for (name, xyz) in illuminants {
        let light = illuminant::by_name(name).expect("a known illuminant");
        let actual = observer::xyz_of_reflectance(&Spectrum::constant(1.0), light);
        close(actual, triple(xyz), 2.0 * SINGLE, name);
    }
}

#[test]
fn colours_of_the_colorchecker_under_d65() {
    let figures = &figures()["colorchecker"];
    let white = triple(&figures["white"]);
    let patches = list(&figures["patches"]);
    assert_eq!((patches.len(), reflectance::colorchecker().len()), (24, 24));
    for (patch, expected) in reflectance::colorchecker().iter().zip(patches) {
        let xyz = observer::xyz_of_reflectance(&patch.reflectance, illuminant::d65());
        close(xyz, triple(&expected["xyz"]), 2.0 * SINGLE, patch.name);
        let Lab { l, a, b } = lab(xyz, white);
        // The slopes of L*, a*, b* reach 1 000 for dark colours; the script's white was converted through x and y.
        close([l, a, b], triple(&expected["lab"]), 1000.0 * SINGLE, patch.name);
    }
}

#[test]
fn colour_differences_of_sharma_wu_and_dalal() {
    let figures = figures();
    let pairs = list(&figures["ciede2000"]);
    assert_eq!(pairs.len(), 33);
    for pair in pairs {
        let [first, second] = ["first", "second"].map(|key| {
            let [l, a, b] = triple(&pair[key]);
            Lab { l, a, b }
        });
        let expected = number(&pair["difference"]);
        // Double precision throughout; square roots of small differences lose half the digits.
        assert!((ciede2000(first, second) - expected).abs() < 1e-9, "{first:?} {second:?}: {expected}");
        assert!((ciede2000(second, first) - expected).abs() < 1e-9, "not symmetric: {first:?} {second:?}");
    }
}

#[test]
fn radiance_of_black_bodies() {
    for value in list(&figures()["blackbody"]) {
        let [kelvin, nm, expected] = ["kelvin", "nm", "radiance"].map(|key| number(&value[key]));
        // Exponents reach 36 and carry the rounding of their factors: 36 × 2e-16.
        assert!((illuminant::planck(nm, kelvin) / expected - 1.0).abs() < 1e-13, "{kelvin} K, {nm} nm");
        let stored = f64::from(illuminant::blackbody(kelvin).at(nm as f32));
        assert!((stored / expected - 1.0).abs() < SINGLE, "{kelvin} K, {nm} nm");
    }
}
