//! Comparison with Mitsuba's `sunsky` emitter, another implementation of the same tables: reference values of `tests/oracles/sky.py`.

use etendue_core::maths::f64::{cos, sin};
use etendue_spectra::sky::{self, SkyModel, sun};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/sky.json");

fn figures() -> Value {
    serde_json::from_str(FIGURES).expect("the figures are JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

/// A row: its numbers, then the list of radiances.
fn row<const N: usize>(value: &Value) -> ([f64; N], Vec<f64>) {
    (core::array::from_fn(|i| value[i].as_f64().expect("a number")), numbers(&value[N]))
}

#[test]
fn the_sky_is_that_of_the_oracle() {
    let figures = figures();
    let nm = numbers(&figures["nm"]);
    let rows = figures["sky"].as_array().expect("a list");
    assert_eq!(rows.len(), 252);
    for value in rows {
        let ([turbidity, albedo, elevation, zenith, azimuth], expected) = row(value);
        let e = elevation.to_radians();
        let sky = SkyModel::new(turbidity, albedo, e).expect("in range");
        let (z, a) = (zenith.to_radians(), azimuth.to_radians());
        let cos_sun = cos(z) * sin(e) + sin(z) * cos(e) * cos(a);
        let bands = sky.band_radiances(cos(z), cos_sun);
        let scale = expected.iter().fold(0.0, |top: f64, v| top.max(*v));
        for (nm, expected) in nm.iter().zip(&expected) {
            let actual = SkyModel::mix(*nm).apply(&bands);
            // The oracle's single precision: 6e-8, times up to 5e2 where its exponentials and their sums nearly cancel.
            // Where the fit is negative both are zero.
            assert!((actual - expected).abs() < 3e-5 * scale, "{value:?} at {nm} nm: {actual}");
        }
    }
}

#[test]
fn the_sun_is_that_of_the_oracle() {
    let figures = figures();
    let nm = numbers(&figures["nm"]);
    let rows = figures["sun"].as_array().expect("a list");
    assert_eq!(rows.len(), 112);
    for value in rows {
        let ([turbidity, elevation, mu], expected) = row(value);
        let bands = sun::band_radiances(turbidity, elevation.to_radians()).expect("in range");
        let scale = expected.iter().fold(0.0, |top: f64, v| top.max(*v));
        for (nm, expected) in nm.iter().zip(&expected) {
            let actual = sky::sun(*nm).apply(&bands) * sun::limb_darkening(*nm, mu);
            // At the limb the reference computes µ from sines of 0.005, to 1e-3 in single precision.
            let tolerance = if mu == 1.0 { 2e-5 } else { 2e-3 };
            assert!((actual - expected).abs() <= tolerance * scale, "{value:?} at {nm} nm: {actual}");
        }
    }
}
