//! What a material asks of its callers, known once for all points.

use super::{Material, Reflectance, Surface};
use crate::textures::TextureId;

/// What holds for a material or any of its parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct MaterialFlags {
    /// Light may pass straight through.
    pub(super) passage: bool,
    /// It has a normal map.
    pub(super) tangents: bool,
    /// It has a texture.
    pub(super) footprint: bool,
    /// It bounds a transparent solid.
    pub(super) solid: bool,
}

impl MaterialFlags {
    fn or(self, other: Self) -> Self {
        Self {
            passage: self.passage | other.passage,
            tangents: self.tangents | other.tangents,
            footprint: self.footprint | other.footprint,
            solid: self.solid | other.solid,
        }
    }
}

/// The flags of each material. The mixes among them are free of circles.
pub(super) fn flags(materials: &[Material]) -> Vec<MaterialFlags> {
    let mut known: Vec<_> = materials.iter().map(own).collect();
    // Every round takes the parts' flags one mix higher up: settled after as many as mixes are nested.
    loop {
        let next: Vec<_> = materials.iter().zip(&known).map(|(m, own)| own.or(of_parts(m, &known))).collect();
        if next == known {
            return known;
        }
        known = next;
    }
}

fn of_parts(material: &Material, known: &[MaterialFlags]) -> MaterialFlags {
    match &material.surface {
        Surface::Mix(mix) => known[mix.a.0 as usize].or(known[mix.b.0 as usize]),
        _ => MaterialFlags::default(),
    }
}

fn own(material: &Material) -> MaterialFlags {
    let passage = material.opacity.is_some() || matches!(material.surface, Surface::ThinSheet(_));
    MaterialFlags {
        passage,
        tangents: material.normal_map.is_some(),
        footprint: !material.textures().is_empty(),
        solid: matches!(material.surface, Surface::Dielectric(_)),
    }
}

impl Material {
    /// The textures that it reads; those of a mix's parts are not among them.
    #[must_use]
    pub fn textures(&self) -> Vec<TextureId> {
        let glow = self.emission.as_ref().and_then(|e| e.factor);
        let opacity = self.opacity.and_then(|o| o.texture());
        let normals = self.normal_map.map(|map| map.texture());
        self.surface.textures().into_iter().chain([glow, opacity, normals]).flatten().collect()
    }
}

impl Surface {
    fn textures(&self) -> [Option<TextureId>; 2] {
        match self {
            Self::Absorber | Self::Marking(_) => [None; 2],
            Self::Diffuse(r) => [r.texture(), None],
            Self::Conductor(conductor) => [None, conductor.alpha().texture()],
            Self::Coated(coated) => [coated.base().texture(), coated.alpha().texture()],
            Self::Lafortune(model) => [model.base().texture(), None],
            Self::BlinnPhong(model) => [model.base().texture(), None],
            Self::CarPaint(paint) => [paint.pigment().texture(), None],
            Self::Cloth(cloth) => [cloth.base().texture(), None],
            Self::Sheeting(sheeting) => [sheeting.print().and_then(Reflectance::texture), None],
            Self::Dielectric(dielectric) => [None, dielectric.alpha().texture()],
            Self::ThinSheet(sheet) => [sheet.transmittance().texture(), None],
            Self::Leaf(leaf) => [leaf.reflectance.texture(), leaf.transmittance.texture()],
            Self::Mix(mix) => [mix.weight.texture(), None],
        }
    }
}
