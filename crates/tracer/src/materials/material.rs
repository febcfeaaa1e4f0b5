//! A material: a surface with what it emits, and with what lies over it.

use super::Surface;
use super::emission::Emission;
use super::factor::Factor;
use super::normal_map::NormalMap;
use super::parameter::Parameter;
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
