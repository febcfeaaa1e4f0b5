//! Materials that are refused.

use super::*;

#[test]
fn faulty_materials_are_refused() {
    let of = |surface| MaterialTable::new(vec![Material::new(surface)], vec![]).err();
    assert!(matches!(of(Surface::Diffuse(grey(1.2))), Some(MaterialError::Reflectance { material: 0, .. })));
    assert!(matches!(of(Surface::Diffuse(grey(-0.1))), Some(MaterialError::Reflectance { .. })));
    let textured = Surface::Diffuse(Reflectance::Texture(crate::textures::TextureId(2)));
    assert_eq!(of(textured), Some(MaterialError::UnknownTexture { material: 0, texture: 2, textures: 0 }));
    assert_eq!(CoatedDiffuse::new(grey(0.5), 1.0, 0.1), Err(MaterialError::CoatIndex { n: 1.0 }));
    assert_eq!(CoatedDiffuse::new(grey(0.5), 1.5, 1.5), Err(MaterialError::Roughness { alpha: 1.5 }));
    assert_eq!(Dielectric::new(0.99, 0.1, None), Err(MaterialError::GlassIndex { n: 0.99 }));
    assert_eq!(Dielectric::new(1.5, 2.0, None), Err(MaterialError::Roughness { alpha: 2.0 }));
    let gain = Some(Spectrum::constant(-1.0));
    assert_eq!(Dielectric::new(1.5, 0.0, gain), Err(MaterialError::Absorption { value: -1.0 }));
    assert!(ThinSheet::new(f64::NAN, grey(0.5)).is_err());
    let nothing = metal::ComplexIndex { n: Spectrum::constant(0.0), k: Spectrum::constant(0.0) };
    assert_eq!(Conductor::new(nothing, 0.1), Err(MaterialError::Index { nm: 300 }));
}

#[test]
fn leaves_send_on_no_more_than_arrives() {
    let of = |r, t| MaterialTable::new(vec![Material::new(leaf(r, t))], vec![]).err();
    assert_eq!(of(0.5, 0.5), None);
    assert!(matches!(of(0.6, 0.5), Some(MaterialError::LeafSum { material: 0, value }) if (value - 1.1).abs() < 1e-6));
    // Spectra are summed node by node: two alternating spectra may each be 1.
    let step = |up: bool| Reflectance::Spectrum(Spectrum::from_fn(|nm| f64::from(u8::from((nm < 600.0) == up))));
    let turns = Surface::Leaf(Box::new(Leaf { reflectance: step(true), transmittance: step(false) }));
    assert!(MaterialTable::new(vec![Material::new(turns)], vec![]).is_ok());
}

#[test]
fn factors_of_textures_are_looked_at() {
    use crate::textures::{Channel, ImageTexture, Sampling, Texels, TextureId};
    let texture = || {
        let texels = Texels::Float(vec![[0.5, 1.5, -0.5]]);
        vec![ImageTexture::new(1, 1, texels, Sampling::default()).expect("a texel")]
    };
    let metal = |channel| {
        let index = metal::by_name("Al").expect("aluminium").clone();
        let alpha = Factor::Texture(TextureId(0), channel);
        Surface::Conductor(Box::new(Conductor::new(index, alpha).expect("a metal")))
    };
    assert!(MaterialTable::new(vec![Material::new(metal(Channel::Red))], texture()).is_ok());
    for (channel, value) in [(Channel::Green, 1.5), (Channel::Blue, -0.5)] {
        let refused = MaterialTable::new(vec![Material::new(metal(channel))], texture()).err();
        let expected = MaterialError::Factor { material: 0, quantity: "a roughness α", value };
        assert_eq!(refused, Some(expected));
    }
    let see_through = Material { opacity: Some(Factor::Number(1.2)), ..Material::new(Surface::Absorber) };
    let refused = MaterialTable::new(vec![see_through], vec![]).err();
    assert_eq!(refused, Some(MaterialError::Factor { material: 0, quantity: "an opacity", value: 1.2 }));
}

#[test]
fn what_counts_on_a_mix_alone_is_refused_on_its_parts() {
    let mix = Surface::Mix(Mix { a: MaterialId(0), b: MaterialId(1), weight: Factor::Number(0.5) });
    let of = |part: Material, outer: Material| {
        MaterialTable::new(vec![Material::new(Surface::Absorber), part, outer], vec![]).err()
    };
    let plain = || Material::new(Surface::Absorber);
    let outer = || Material::new(mix.clone());
    assert_eq!(of(plain(), outer()), None);
    let cut = Material { opacity: Some(Factor::Number(0.5)), ..plain() };
    let refused = MaterialError::Part { material: 2, part: 1, what: "an opacity" };
    assert_eq!(of(cut, outer()), Some(refused));
    let map = NormalMap::new(crate::textures::TextureId(0), GreenDirection::Up, 1.0).expect("a map");
    let bent = Material { normal_map: Some(map), ..outer() };
    assert_eq!(of(plain(), bent), Some(MaterialError::MixNormal { material: 2 }));
}

/// Light sampling on an emitting surface has only its texture coordinates.
#[test]
fn what_emits_has_no_gaps_laid_on_from_three_sides() {
    use crate::textures::{Channel, ImageTexture, Projection, Sampling, Texels, TextureId};
    let of = |emission| {
        let projection = Projection::Triplanar { size_m: 1.0, sharpness: 4.0 };
        let sampling = Sampling { projection, ..Sampling::default() };
        let image = ImageTexture::new(1, 1, Texels::Float(vec![[0.5; 3]]), sampling).expect("a texel");
        let opacity = Some(Factor::Texture(TextureId(0), Channel::Red));
        MaterialTable::new(vec![Material { emission, opacity, ..Material::new(Surface::Absorber) }], vec![image]).err()
    };
    let emitted =
        Emission { radiance: Spectrum::constant(1.0), factor: None, sides: EmissionSides::Both, modulation: None };
    assert_eq!(of(None), None);
    let refused = MaterialError::Projected { material: 0, what: "an opacity together with an emission" };
    assert_eq!(of(Some(emitted)), Some(refused));
}
