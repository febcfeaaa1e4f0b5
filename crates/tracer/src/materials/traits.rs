//! What a material asks of its callers, known once for all points.

use super::{Material, Reflectance, Surface};

/// What holds for a material or any of its parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Traits {
    /// Light may pass straight through.
    pub(super) passage: bool,
    /// It has a normal map.
    pub(super) tangents: bool,
    /// It has a texture.
    pub(super) footprint: bool,
}

impl Traits {
    fn or(self, other: Self) -> Self {
        Self {
            passage: self.passage | other.passage,
            tangents: self.tangents | other.tangents,
            footprint: self.footprint | other.footprint,
        }
    }
}

/// The traits of each material. The mixes among them are free of circles.
pub(super) fn traits(materials: &[Material]) -> Vec<Traits> {
    let mut known: Vec<_> = materials.iter().map(own).collect();
    // Every round takes the parts' traits one mix higher up: settled after as many as mixes are nested.
    loop {
        let next: Vec<_> = materials.iter().zip(&known).map(|(m, own)| own.or(of_parts(m, &known))).collect();
        if next == known {
            return known;
        }
        known = next;
    }
}

fn of_parts(material: &Material, known: &[Traits]) -> Traits {
    match &material.surface {
        Surface::Mix(mix) => known[mix.a.0 as usize].or(known[mix.b.0 as usize]),
        _ => Traits::default(),
    }
}

fn own(material: &Material) -> Traits {
    let is_textured = |r: &Reflectance| matches!(r, Reflectance::Texture(_));
    let surface = match &material.surface {
        Surface::Absorber | Surface::Conductor(_) => false,
        Surface::Diffuse(r) => is_textured(r),
        Surface::Coated(coated) => is_textured(coated.base()),
        Surface::Lafortune(model) => is_textured(model.base()),
        Surface::BlinnPhong(model) => is_textured(model.base()),
        Surface::Mix(mix) => mix.weight.texture().is_some(),
    };
    let glows = material.emission.as_ref().is_some_and(|e| e.factor.is_some());
    let cut = material.opacity.is_some_and(|o| o.texture().is_some());
    let tangents = material.normal_map.is_some();
    Traits { passage: material.opacity.is_some(), tangents, footprint: surface || glows || cut || tangents }
}
