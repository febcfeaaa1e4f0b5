//! Ground under water.

use super::*;
use crate::materials::{Puddles, WATER};
use crate::textures::{Channel, ImageTexture, Sampling, Texels, TextureId, Wrap};

/// Lekner and Dorf (1988): A_wet = (1 − R₀)(1 − p) A/(1 − p A), p = 0.47459, and the film's specular reflectance R₀ = 0.02037.
#[test]
fn wet_ground_is_as_dark_as_lekner_and_dorf_say() {
    let darkened =
        [(0.05, 0.0264), (0.10, 0.0540), (0.15, 0.0831), (0.20, 0.1137), (0.30, 0.180), (0.50, 0.337), (0.80, 0.664)];
    for (dry, wet) in darkened {
        let material_table = material_table(paint(dry, WATER, 0.0));
        let actual = albedos_of::<{ 1 << 20 }>(&bsdf(&material_table), Vec3::Z)[0][0];
        // The figures have three digits; the quadrature errs by 3e-4.
        assert!((f64::from(actual) - 0.0204 - wet).abs() < 8e-4, "{dry}: {actual}");
    }
}

/// A puddle is a mirror of 0.72 at 87° where it is deeper than the grains, and as rough as a film where the ground protrudes.
#[test]
fn a_puddle_mirrors_by_fresnel() {
    let sampling = Sampling { wrap: [Wrap::Clamp; 2], ..Sampling::default() };
    let heights = ImageTexture::new(2, 1, Texels::Float(vec![[0.1; 3], [0.9; 3]]), sampling).expect("a picture");
    let puddles = Puddles::new(
        Factor::Texture(TextureId(0), Channel::Red),
        GroundRelief { relief_mm: 10.0, level_mm: 5.0, grain_mm: 2.0 },
        0.2,
        0.0,
    )
    .expect("legal");
    let surface = Surface::from(CoatedDiffuse::under_water(grey(0.1), puddles));
    let material_table = MaterialTable::new(vec![Material::new(surface)], vec![heights]).expect("a map");
    let at = |u: f32| material_table.bsdf(MaterialId(0), &Lookup::point(Vec2::new(u, 0.5)), true, &WAVELENGTHS);
    let (deep, film) = (at(0.25), at(0.75));
    let wo = at_degrees(87.0);
    // The mirror is sampled by its fraction of the reflected light: its weight by that is the Fresnel factor.
    let n = 4096;
    let mirrored: f32 = (0..n)
        .filter_map(|i| deep.sample(wo, (i as f32 + 0.5) / n as f32, Vec2::splat(0.5)))
        .filter(|sample| sample.event == Event::Specular)
        .map(|sample| sample.weight[0] / n as f32)
        .sum();
    assert!((mirrored - 0.7219).abs() < 2e-3, "{mirrored}");
    let rough = film.sample(Vec3::Z, 0.0, Vec2::new(0.3, 0.4)).expect("it reflects");
    assert_eq!(rough.event, Event::Scatter);
}
