//! Intensities and fluxes compared with other readers, also on files of other writers: tests/oracles/lamps.py.

use std::path::{Path, PathBuf};

use etendue_io::photometry::read_photometry;
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../../tests/oracles/figures/lamps.json");

fn figures() -> Value {
    serde_json::from_str(FIGURES).expect("JSON")
}

fn lamp(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/lamps").join(name)
}

#[test]
fn intensities_are_those_that_other_programs_read() {
    let figures = figures();
    let mut compared = 0;
    for (name, readers) in figures["lamps"].as_object().expect("lamps") {
        let read = read_photometry(&lamp(name)).unwrap_or_else(|error| panic!("{error}"));
        for (reader, cells) in readers.as_object().expect("readers") {
            for cell in cells.as_array().expect("cells") {
                let [c, gamma, expected] = [0, 1, 2].map(|i| cell[i].as_f64().expect("a number"));
                let actual = read.candela_at(c, gamma);
                // Products of three or four factors, in another order.
                assert!(
                    (actual - expected).abs() <= 1e-12 * expected,
                    "{name}, {reader}: {actual} at C{c}, {gamma}°, not {expected}"
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 1000, "{compared} intensities");
}

#[test]
fn the_flux_is_that_of_a_numerical_quadrature() {
    for (name, expected) in figures()["flux_lm"].as_object().expect("fluxes") {
        let (actual, expected) =
            (read_photometry(&lamp(name)).expect("readable").flux_lm(), expected.as_f64().expect("lm"));
        // The quadrature is requested with 1e-6 cd·deg² per cell at most, and is better by orders of magnitude.
        assert!((actual - expected).abs() < 1e-9 * expected, "{name}: {actual}, not {expected}");
    }
}
