//! A material: a surface with its emission, opacity and normal map.
//!
//! Mixes: each light path hits one of two materials, at random.
//!
//! f = (1 − w)·f_a + w·f_b: parts `a` and `b` side by side, finer than any resolution, w the fraction of b. No density of the mix is ever needed: a
//! path samples its material at every vertex, and is then a path over that material. The parts may be mixes themselves, but may not contain
//! themselves.

use super::parameter::{Factor, Parameter};
use super::{Surface, emission::Emission, model::Passage, shading::NormalMap};
use crate::{MaterialId, textures::TextureId};

/// A material: scattering and emission of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Scattering of the surface.
    pub surface: Surface,
    /// Emission; `None` if it does not emit.
    pub emission: Option<Emission>,
    /// Opaque fraction of the surface, 0 to 1: through the rest light passes straight. `None` if it is fully opaque.
    pub opacity: Option<Factor>,
    pub normal_map: Option<NormalMap>,
}

impl Material {
    /// A material that only scatters.
    #[must_use]
    pub fn new(surface: impl Into<Surface>) -> Self {
        Self { surface: surface.into(), emission: None, opacity: None, normal_map: None }
    }

    /// The textures that it reads, without those of a mix's parts.
    #[must_use]
    pub fn textures(&self) -> Vec<TextureId> {
        let of_surface = self.surface.parameters().into_iter().map(|p: Parameter<'_>| p.texture());
        let emission = self.emission.as_ref().and_then(|e| e.factor);
        let opacity = self.opacity.and_then(|o| o.texture());
        let normals = self.normal_map.map(|map| map.texture());
        of_surface.chain([emission, opacity, normals]).flatten().collect()
    }
}

/// Properties of a material or any of its parts.
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

/// The flags of each material. No mix contains itself.
pub(super) fn flags(materials: &[Material]) -> Vec<MaterialFlags> {
    let mut known: Vec<_> = materials.iter().map(own_flags).collect();
    // Each iteration passes the parts' flags one mix higher up. It converges after as many iterations as mixes are nested.
    loop {
        let next: Vec<_> = materials.iter().zip(&known).map(|(m, own)| own.or(part_flags(m, &known))).collect();
        if next == known {
            return known;
        }
        known = next;
    }
}

fn part_flags(material: &Material, known: &[MaterialFlags]) -> MaterialFlags {
    match &material.surface {
        Surface::Mix(mix) => known[mix.a.0 as usize].or(known[mix.b.0 as usize]),
        _ => MaterialFlags::default(),
    }
}

fn own_flags(material: &Material) -> MaterialFlags {
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

/// Two materials side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix {
    /// The material of weight 1 − w.
    pub a: MaterialId,
    /// The material of weight w.
    pub b: MaterialId,
    /// w, 0 to 1.
    pub weight: Factor,
}

impl Mix {
    pub(super) fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Factor(self.weight, "a weight")]
    }
}

/// The part selected by `u` in [0, 1), and the place of `u` within it, again in [0, 1).
pub(super) fn choose(mix: &Mix, weight: f32, u: f32) -> (MaterialId, f32) {
    let (part, u) = if u < weight { (mix.b, u / weight) } else { (mix.a, (u - weight) / (1.0 - weight)) };
    (part, u.clamp(0.0, 1.0_f32.next_down()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mix(a: u32, b: u32) -> Mix {
        Mix { a: MaterialId(a), b: MaterialId(b), weight: Factor::Number(0.25) }
    }

    #[test]
    fn shares_are_as_stated_and_the_rest_of_the_number_is_uniform() {
        let (mut of_b, mut sum) = (0, 0.0);
        for i in 0..1000 {
            let (part, rest) = choose(&mix(0, 1), 0.25, (i as f32 + 0.5) / 1000.0);
            of_b += u32::from(part == MaterialId(1));
            sum += rest / 1000.0;
        }
        assert_eq!(of_b, 250);
        assert!((sum - 0.5).abs() < 1e-4);
        assert_eq!(choose(&mix(0, 1), 0.0, 0.0).0, MaterialId(0));
        assert_eq!(choose(&mix(0, 1), 1.0, 0.999_999_94).0, MaterialId(1));
        for (weight, u) in [(1e-30, 0.0), (1.0, 0.999_999_94), (0.999_999_94, 0.999_999_94)] {
            assert!((0.0..1.0).contains(&choose(&mix(0, 1), weight, u).1));
        }
    }
}
