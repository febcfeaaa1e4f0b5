//! A material: a surface with what it emits, and with what lies over it.

use super::Surface;
use super::emission::Emission;
use super::model::Passage;
use super::normal_map::NormalMap;
use super::parameter::{Factor, Parameter};
use crate::textures::TextureId;

/// A material: what happens to light at a surface, and what light starts there.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub surface: Surface,
    /// What it emits; `None` where it does not glow.
    pub emission: Option<Emission>,
    /// Share of the surface that is there, 0 to 1: through the rest light goes straight. `None` where all of it is.
    pub opacity: Option<Factor>,
    /// Finer normals than the mesh's.
    pub normal_map: Option<NormalMap>,
}

impl Material {
    /// A material that only scatters.
    #[must_use]
    pub fn new(surface: impl Into<Surface>) -> Self {
        Self { surface: surface.into(), emission: None, opacity: None, normal_map: None }
    }

    /// The textures that it reads; those of a mix's parts are not among them.
    #[must_use]
    pub fn textures(&self) -> Vec<TextureId> {
        let of_surface = self.surface.parameters().into_iter().map(|p: Parameter<'_>| p.texture());
        let emission = self.emission.as_ref().and_then(|e| e.factor);
        let opacity = self.opacity.and_then(|o| o.texture());
        let normals = self.normal_map.map(|map| map.texture());
        of_surface.chain([emission, opacity, normals]).flatten().collect()
    }
}

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
