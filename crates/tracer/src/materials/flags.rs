//! What holds for a material or any of its parts, known once for all points.

use super::Surface;
use super::material::Material;
use super::model::Passage;

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
    let (straight, solid) = match material.surface.passage() {
        Passage::None => (false, false),
        Passage::Straight => (true, false),
        Passage::Solid(_) => (false, true),
    };
    MaterialFlags {
        passage: material.opacity.is_some() || straight,
        tangents: material.normal_map.is_some(),
        footprint: !material.textures().is_empty(),
        solid,
    }
}
