//! Lamps on planes and walls, against the inverse square law and their own files.

use crate::irradiance::plane;
use core::f64::consts::PI;
use etendue_core::maths::f64::{acos, cos};
use etendue_scene::asset::{PhotometryAsset, PhotometryAxes};
use etendue_spectra::{illuminant, observer};
use etendue_tests::{Job, Samples};
use glam::DVec3;

const REFLECTANCE: f64 = 0.5;

/// Spectral irradiance in 500 … 600 nm (mean) of 1 lx of light of this spectrum, W·m⁻²·nm⁻¹.
fn per_lux(name: &str) -> f64 {
    let relative = illuminant::named(name).expect("an illuminant");
    observer::with_luminance(relative, 1.0).expect("visible").band_mean(500.0, 600.0)
}

fn assert_lit(seen: &Samples, lux: impl Fn(usize) -> f64, what: &str) {
    for (i, mean) in seen.mean.iter().enumerate() {
        let expected = REFLECTANCE / PI * lux(i) * per_lux("D65");
        // A lamp without extent has no noise here but that of the pixel's size and of the wavelength within the band, which
        // 256 samples in strata leave at some 1e-4 each.
        let error = (f64::from(*mean) - expected).abs();
        assert!(error <= 1e-3 * expected + 1e-12, "{what}, pixel {i}: {mean} for {expected}");
    }
}

#[test]
fn a_spot_lights_by_the_inverse_square_law_within_its_cone() {
    let spot = "[[scene.lights]]\ntype = \"spot\"\nname = \"spot\"\nposition_m = [0.5, -3, 4]\ntarget_m = [0.5, -3, 0]\n\
                field_angle_deg = 90\ninner_angle_deg = 40\nintensity_cd = 1000\nilluminant = \"D65\"";
    let at = DVec3::new(0.5, -3.0, 4.0);
    let seen = plane(spot).shot().radiance();
    let inner = cos(f64::to_radians(20.0));
    let mut lit = 0;
    for i in 0..64 {
        let way = at - crate::irradiance::point(i);
        let (d2, cosine) = (way.length_squared(), way.z / way.length());
        // Pixels wholly within the inner cone, wholly outside, and the soft edge between, where only the order is known.
        let expected = REFLECTANCE / PI * 1000.0 * cosine / d2 * per_lux("D65");
        let mean = f64::from(seen.mean[i]);
        let angle = f64::to_degrees(acos(cosine));
        if angle < 10.0 || (angle < 12.0 && cosine > inner) {
            lit += 1;
            assert!((mean / expected - 1.0).abs() < 1e-3, "{angle}: {mean} {expected}");
        } else if angle > 54.0 {
            assert_eq!(mean, 0.0, "{angle}");
        } else {
            assert!(mean <= expected * 1.001, "{angle}");
        }
    }
    assert!(lit >= 1, "some pixels lie in the inner cone");
}

#[test]
fn the_paper_s_attenuation_comes_on_top() {
    let lamp = |more: &str| {
        let lamp = format!(
            "[[scene.lights]]\ntype = \"point\"\nname = \"lamp\"\nposition_m = [0, -4, 5]\nluminous_flux_lm = 12566.3706\n\
             illuminant = \"D65\"\n{more}"
        );
        plane(&lamp).shot().radiance()
    };
    let way = |i: usize| DVec3::new(0.0, -4.0, 5.0) - crate::irradiance::point(i);
    let lux = |i: usize| 1000.0 * way(i).z / (way(i).length() * way(i).length_squared());
    assert_lit(&lamp(""), lux, "clear air");
    let attenuated = |i: usize| lux(i) / (1.0 + 0.2 * way(i).length());
    assert_lit(&lamp("attenuation_per_m = 0.2"), attenuated, "a = 0.2");
}
