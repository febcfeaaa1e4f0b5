//! White surfaces in uniform light reflect all of it, within 1e-3 at every roughness and angle.

use super::reflection::*;
use super::*;

/// Allowed difference from 1: 3e-4 of it are the sum's.
const MAX_DIFFERENCE: f32 = 1e-3;

fn sent_back(material_table: &MaterialTable, degrees: f32) -> f32 {
    albedos_of::<{ 1 << 20 }>(&bsdf(material_table), at_degrees(degrees))[0][0]
}

/// A conductor that reflects all but 4e-12, by the largest legal numbers.
fn bright_metal() -> metal::ComplexIndex {
    metal::ComplexIndex { n: Spectrum::constant(1e-4), k: Spectrum::constant(1e4) }
}

fn assert_white(name: &str, surface: Surface, angles: &[f32]) {
    let material_table = material_table(surface);
    for degrees in angles {
        let sent = sent_back(&material_table, *degrees);
        assert!((sent - 1.0).abs() < MAX_DIFFERENCE, "{name} at {degrees}°: {sent}");
    }
}

#[test]
fn white_ggx_facets_send_back_all_light() {
    for alpha in [3e-4, 0.01, 0.13, 0.25, 0.32, 0.7, 1.0] {
        let surface = rough(&bright_metal(), alpha, Distribution::Ggx, true);
        assert_white(&format!("α {alpha}"), surface, &[0.0, 40.0, 75.0, 89.0, 89.99]);
    }
}

#[test]
fn white_beckmann_facets_send_back_all_light() {
    for alpha in [3e-4, 0.1, 0.32, 0.7, 1.0] {
        let surface = rough(&bright_metal(), alpha, Distribution::Beckmann, true);
        assert_white(&format!("α {alpha}"), surface, &[0.0, 72.0, 89.9]);
    }
}

#[test]
fn white_coated_bases_send_back_all_light() {
    for (n, alpha) in [(1.1, 1e-4), (1.5, 1e-3), (1.1, 0.01), (4.0, 0.05), (4.0, 0.2), (1.5, 0.5), (4.0, 1.0)] {
        assert_white(&format!("n {n} α {alpha}"), paint(1.0, n, alpha), &[0.0, 60.0, 89.0, 89.9, 89.99]);
    }
}

#[test]
fn white_cloth_sends_back_all_light() {
    for alpha in [0.1, 0.3, 1.0] {
        assert_white(&format!("α {alpha}"), cloth(1.0, 1.0, alpha), &[0.0, 60.0, 89.0, 89.9, 89.99]);
    }
}

#[test]
fn car_paint_never_sends_back_more_than_arrives() {
    for (coverage, flake_alpha, coat_alpha) in [(0.0, 0.3, 0.0), (0.5, 0.1, 0.0), (1.0, 0.05, 0.0), (0.7, 0.3, 0.1)] {
        let material_table = material_table(car_paint(1.0, 1.0, coverage, flake_alpha, coat_alpha));
        for degrees in [0.0, 40.0, 75.0, 89.0, 89.99] {
            let sent = sent_back(&material_table, degrees);
            assert!(sent < 1.0 + MAX_DIFFERENCE, "{coverage} {flake_alpha} {coat_alpha} at {degrees}°: {sent}");
        }
    }
}

/// Widening of facets with unchanged energy tables loses light and never adds any.
#[test]
fn widened_facets_never_send_back_more_than_arrives() {
    let white = [
        ("metal", rough(&bright_metal(), 0.0, Distribution::Ggx, true)),
        ("thin coat", paint(1.0, 1.1, 1e-3)),
        ("coat", paint(1.0, 1.5, 0.0)),
        ("dense coat", paint(1.0, 4.0, 0.05)),
        ("car paint", car_paint(1.0, 1.0, 0.7, 0.1, 0.0)),
        ("glass", glass(1.5, 0.0)),
    ];
    for (name, surface) in white {
        let material_table = material_table(surface);
        for min_alpha in [0.1, 0.26, 0.54] {
            let widened = material_table.widened_bsdf(MaterialId(0), &LOOKUP, true, min_alpha, &WAVELENGTHS);
            assert!(!widened.is_delta(), "{name}");
            for degrees in [0.0, 40.0, 75.0, 89.0] {
                let sent = albedos_of::<{ 1 << 18 }>(&widened, at_degrees(degrees))[0][0];
                assert!(sent < 1.0 + MAX_DIFFERENCE, "{name} of {min_alpha} at {degrees}°: {sent}");
                // GGX facets lose multiple scattering, more towards grazing; for wide flakes the internal reflection of the coat is larger
                // than in its table. The sum is of reflected light: for glass a part.
                let floor = match name {
                    "glass" => 0.0,
                    "car paint" => 0.4,
                    _ if degrees > 60.0 => 0.5,
                    _ => 0.85,
                };
                assert!(sent > floor, "{name} of {min_alpha} at {degrees}°: {sent}");
            }
        }
    }
}
