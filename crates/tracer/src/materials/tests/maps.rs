//! Factors over a surface: mixes, opacity, roughness.

use super::*;
use crate::textures::{Channel, ImageTexture, Sampling, Texels, TextureId, Wrap};

/// An image of four greys side by side: 0, 1/3, 2/3, 1; without filtering between them at their centres.
fn ramp() -> ImageTexture {
    let texels = (0..4).map(|i| [i as f32 / 3.0; 3]).collect();
    let sampling = Sampling { wrap: [Wrap::Clamp; 2], ..Sampling::default() };
    ImageTexture::new(4, 1, Texels::Float(texels), sampling).expect("a picture")
}

const RAMP: Factor = Factor::Texture(TextureId(0), Channel::Red);

fn at(i: usize) -> Lookup {
    Lookup::point(Vec2::new((i as f32 + 0.5) / 4.0, 0.5))
}

#[test]
fn a_mix_follows_its_map() {
    let mix = Surface::Mix(Mix { a: MaterialId(0), b: MaterialId(1), weight: RAMP });
    let materials = [Surface::Diffuse(grey(0.2)), Surface::Diffuse(grey(0.6)), mix].map(Material::new).to_vec();
    let material_table = MaterialTable::new(materials, vec![ramp()]).expect("a mix");
    for i in 0..4 {
        let resolved = (0..3000).map(|k| material_table.resolve(MaterialId(2), &at(i), (k as f32 + 0.5) / 3000.0));
        let of_b = resolved.filter(|id| *id == MaterialId(1)).count();
        assert!(of_b.abs_diff(i * 1000) <= 1, "{of_b}");
    }
    assert!(material_table.needs_footprint(MaterialId(2)) && !material_table.needs_footprint(MaterialId(1)));
}

#[test]
fn passages_of_cut_out_mixes_are_means() {
    let mix = Surface::Mix(Mix { a: MaterialId(0), b: MaterialId(1), weight: Factor::Number(0.25) });
    let masked = Material { opacity: Some(RAMP), ..Material::new(mix) };
    let materials = vec![Material::new(Surface::Absorber), Material::new(pane(1.5, 1.0)), masked];
    let material_table = MaterialTable::new(materials, vec![ramp()]).expect("a mix");
    assert_eq!(material_table.passage(MaterialId(0), &at(0), &|_| 1.0, &WAVELENGTHS), None);
    for i in 0..4 {
        let opacity = i as f32 / 3.0;
        let expected = 1.0 - opacity + opacity * 0.25 * 0.96 / 1.04;
        let passage = material_table.passage(MaterialId(2), &at(i), &|_| 1.0, &WAVELENGTHS).expect("a passage");
        assert!(
            (passage[2] - expected).abs() < 1e-6
                && (material_table.opacity(MaterialId(2), &at(i)) - opacity).abs() < 1e-6
        );
    }
}

#[test]
fn what_is_cut_out_does_not_emit() {
    let emission =
        Emission { radiance: Spectrum::constant(6.0), factor: None, sides: EmissionSides::Both, modulation: None };
    let lamp = Material { emission: Some(emission), opacity: Some(RAMP), ..Material::new(Surface::Absorber) };
    let material_table = MaterialTable::new(vec![lamp], vec![ramp()]).expect("a lamp");
    let emission = material_table.emission(MaterialId(0)).expect("it glows");
    for i in 0..4 {
        let radiance = material_table.radiance(
            MaterialId(0),
            emission,
            &at(i),
            EmissionQuery { wavelengths: &WAVELENGTHS, interval: &etendue_core::TimeInterval::default() },
        );
        assert!((radiance[0] - 2.0 * i as f32).abs() < 1e-5);
    }
}

#[test]
fn a_roughness_map_is_that_roughness_at_each_point() {
    let index = metal::by_name("Cu").expect("copper").clone();
    let metal = |alpha: Factor| Surface::Conductor(Box::new(Conductor::new(index.clone(), alpha).expect("a metal")));
    let glass = |alpha: Factor| Surface::Dielectric(Box::new(Dielectric::new(1.5, alpha, None).expect("a glass")));
    let (wo, wi) = (at_degrees(30.0), Vec3::new(-0.3, 0.2, 0.932_738));
    for of in [&metal as &dyn Fn(Factor) -> Surface, &glass] {
        let mapped = MaterialTable::new(vec![Material::new(of(RAMP))], vec![ramp()]).expect("a map");
        assert!(mapped.needs_footprint(MaterialId(0)));
        for i in 0..4 {
            let one = material_table(of(Factor::Number(i as f32 / 3.0)));
            let bsdf = mapped.bsdf(MaterialId(0), &at(i), true, &WAVELENGTHS);
            assert_eq!(bsdf.evaluate(wo, wi), super::bsdf(&one).evaluate(wo, wi));
            assert_eq!(bsdf.is_delta(), i == 0);
        }
    }
}

#[test]
fn a_white_base_under_a_mapped_coat_keeps_all_light() {
    let coated = CoatedDiffuse::new(grey(1.0), 1.5, RAMP).expect("a paint");
    let material_table =
        MaterialTable::new(vec![Material::new(Surface::Coated(Box::new(coated)))], vec![ramp()]).expect("a map");
    for u in [0.125, 0.2, 0.3, 0.6, 0.875] {
        let bsdf = material_table.bsdf(MaterialId(0), &Lookup::point(Vec2::new(u, 0.5)), true, &WAVELENGTHS);
        for degrees in [0.0, 60.0, 80.0, 88.0] {
            let albedo = albedo(&bsdf, at_degrees(degrees));
            // Error of the table over roughness (see `coated`), in addition to the 3e-3 of single roughnesses.
            assert!((albedo.max_value() - 1.0).abs() < 1e-2, "{u} at {degrees}: {albedo:?}");
        }
    }
}

/// Schlick's approximation by its formula, at a mirror and at a white rough metal with multiple scattering, which keeps all light. Single
/// scattering is in `evaluate`, F₀ at normal incidence in proportion.
#[test]
fn a_metal_of_an_image_reflects_its_colours_as_schlick_says() {
    let metal = |alpha: f64| Conductor::from_texture(TextureId(0), alpha).expect("a metal");
    let of = |metal: Conductor| {
        let surface = Surface::Conductor(Box::new(metal));
        MaterialTable::new(vec![Material::new(surface)], vec![ramp()]).expect("a map")
    };
    let (mirror, once, all) = (of(metal(0.0)), of(metal(0.6)), of(metal(0.6).with_interreflection()));
    assert!(mirror.needs_footprint(MaterialId(0)));
    for i in 0..4 {
        let normal = i as f32 / 3.0;
        for degrees in [0.0, 40.0, 75.0] {
            let wo = at_degrees(degrees);
            let bsdf = mirror.bsdf(MaterialId(0), &at(i), true, &WAVELENGTHS);
            let rest = 1.0 - wo.z;
            let expected = normal + (1.0 - normal) * rest * rest * rest * rest * rest;
            let weight = bsdf.sample(wo, 0.5, Vec2::splat(0.5)).expect("a mirror").weight[1];
            // Greys of a texture are upsampled in 32 bits.
            assert!((weight - expected).abs() < 1e-5, "{normal} at {degrees}: {weight} for {expected}");
        }
    }
    let [once, all] = [&once, &all].map(|table| table.bsdf(MaterialId(0), &at(3), true, &WAVELENGTHS));
    for degrees in [0.0, 50.0, 80.0] {
        let wo = at_degrees(degrees);
        let (once, all) = (albedo(&once, wo).max_value(), albedo(&all, wo).max_value());
        // 3e-3 is that of the table of losses, as for metals of one colour.
        assert!((all - 1.0).abs() < 5e-3 && once < all, "{degrees}: {once} {all}");
    }
}
