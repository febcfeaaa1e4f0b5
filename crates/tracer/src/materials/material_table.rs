//! The materials and textures of a world, checked once.

use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::Spectrum;
use glam::Vec3;

use super::emission::{Emission, EmissionQuery};
use super::material::{self, Material, MaterialFlags, flags};
use super::{
    Bsdf, DiffuseBsdf, Reflectance, Surface, check, error::MaterialError, model::Passage, parameter::ShadingPoint,
};
use crate::textures::{ImageTexture, Lookup};
use crate::{MaterialId, geometry::SurfacePoint};

/// Materials and textures. Immutable; every texture and part that a material names is here, every reflectance lies in 0–1. The methods that
/// take a material's id panic on one of another material_table.
#[derive(Clone, Debug, Default)]
pub struct MaterialTable {
    materials: Vec<Material>,
    textures: Vec<ImageTexture>,
    flags: Vec<MaterialFlags>,
    has_passages: bool,
}

impl MaterialTable {
    /// Materials, in the order of their ids, and the textures they name.
    ///
    /// # Errors
    /// If a material names a missing texture or part, is mixed of itself, reflects more than arrives, or has an invalid emission.
    pub fn new(materials: Vec<Material>, textures: Vec<ImageTexture>) -> Result<Self, MaterialError> {
        (0..materials.len()).try_for_each(|i| check::material(&materials, i, &textures))?;
        let flags = flags(&materials);
        let has_passages = flags.iter().any(|t| t.passage);
        Ok(Self { materials, textures, flags, has_passages })
    }

    /// The materials, in the order of their ids.
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The textures, in the order of their ids.
    #[must_use]
    pub fn textures(&self) -> &[ImageTexture] {
        &self.textures
    }

    /// Failure to read a tile of a texture during rendering, if there was one: the result must not be used then.
    #[must_use]
    pub fn texture_failure(&self) -> Option<&str> {
        self.textures.iter().find_map(|texture| texture.tiles().and_then(|(_, memory)| memory.failure()))
    }

    /// True if the strength of any surface's light changes over time.
    #[must_use]
    pub fn is_modulated(&self) -> bool {
        self.materials.iter().any(|m| m.emission.as_ref().is_some_and(|emission| emission.modulation.is_some()))
    }

    /// True if any material passes light straight through.
    #[must_use]
    pub fn has_passages(&self) -> bool {
        self.has_passages
    }

    /// True if a material, or any of its parts, passes light straight through.
    #[must_use]
    pub fn lets_pass(&self, id: MaterialId) -> bool {
        self.flags[id.0 as usize].passage
    }

    /// True if a material, or any of its parts, has a normal map: only then does [`MaterialTable::shading_normal`] use tangents.
    #[must_use]
    pub fn needs_tangents(&self, id: MaterialId) -> bool {
        self.flags[id.0 as usize].tangents
    }

    /// True if a material, or any of its parts, has a texture: only then is the width of a [`Lookup`] used.
    #[must_use]
    pub fn needs_footprint(&self, id: MaterialId) -> bool {
        self.flags[id.0 as usize].footprint
    }

    /// A material's emission.
    #[must_use]
    pub fn emission(&self, id: MaterialId) -> Option<&Emission> {
        self.materials[id.0 as usize].emission.as_ref()
    }

    /// Radiance (W·m⁻²·sr⁻¹·nm⁻¹) of an emitting side at a point: `emission` times the material's opacity, as it counts before the path
    /// decides whether the surface is hit or passed.
    pub(crate) fn radiance<const N: usize>(
        &self,
        id: MaterialId,
        emission: &Emission,
        lookup: &Lookup,
        query: EmissionQuery<'_, N>,
    ) -> Spectral<N> {
        let full = emission.at(&self.textures, lookup, query);
        match self.materials[id.0 as usize].opacity {
            None => full,
            Some(opacity) => full * opacity.at(&self.textures, lookup),
        }
    }

    /// Opaque fraction of a material's surface at a point; 1 without an opacity.
    #[must_use]
    pub fn opacity(&self, id: MaterialId, lookup: &Lookup) -> f32 {
        self.materials[id.0 as usize].opacity.map_or(1.0, |opacity| opacity.at(&self.textures, lookup))
    }

    /// Fraction of light that comes straight through a surface at a point: 1 − opacity + opacity × the transmittance of the surface itself.
    /// `cos` returns the cosine from the shading normal, in (0, 1], at which the material or a part of it is hit. `None` if nothing ever
    /// passes.
    #[must_use]
    pub fn passage<const N: usize>(
        &self,
        id: MaterialId,
        lookup: &Lookup,
        cos: &impl Fn(MaterialId) -> f32,
        wavelengths: &Wavelengths<N>,
    ) -> Option<Spectral<N>> {
        self.lets_pass(id).then(|| {
            let opacity = self.opacity(id, lookup);
            Spectral::splat(1.0 - opacity) + self.through(id, lookup, cos, wavelengths) * opacity
        })
    }

    /// Straight transmittance of the surface itself; for a mix the mean of its parts.
    fn through<const N: usize>(
        &self,
        id: MaterialId,
        lookup: &Lookup,
        cos: &impl Fn(MaterialId) -> f32,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        match &self.materials[id.0 as usize].surface {
            Surface::Mix(parts) if self.lets_pass(parts.a) || self.lets_pass(parts.b) => {
                let weight = parts.weight.at(&self.textures, lookup);
                let [a, b] = [parts.a, parts.b].map(|part| self.through(part, lookup, cos, wavelengths));
                a * (1.0 - weight) + b * weight
            }
            surface if matches!(surface.passage(), Passage::Straight) => {
                surface.straight_transmittance(&self.point(lookup, true, wavelengths), cos(id))
            }
            _ => Spectral::ZERO,
        }
    }

    /// Absorption coefficient inside a solid that this material bounds, 1/m; `None` if nothing is absorbed, or the material bounds no
    /// solid. The id is a resolved one.
    #[must_use]
    pub fn absorption(&self, id: MaterialId) -> Option<&Spectrum> {
        match self.materials[id.0 as usize].surface.passage() {
            Passage::Solid(absorption) => absorption,
            Passage::None | Passage::Straight => None,
        }
    }

    /// True if any material bounds a transparent solid.
    #[must_use]
    pub fn has_solids(&self) -> bool {
        self.flags.iter().any(|t| t.solid)
    }

    /// The material of the transparent solid that a material bounds: itself or, for a mix, its first such part; `None` if it bounds none.
    #[must_use]
    pub fn solid(&self, id: MaterialId) -> Option<MaterialId> {
        if !self.flags[id.0 as usize].solid {
            return None;
        }
        match &self.materials[id.0 as usize].surface {
            Surface::Mix(parts) => self.solid(parts.a).or_else(|| self.solid(parts.b)),
            _ => Some(id),
        }
    }

    /// True if all surfaces absorb, or are diffuse with one spectrum each, and are fully opaque and flat.
    pub(crate) fn is_diffuse_only(&self) -> bool {
        self.materials.iter().all(|material| {
            let surface = matches!(material.surface, Surface::Absorber | Surface::Diffuse(Reflectance::Spectrum(_)));
            surface && material.opacity.is_none() && material.normal_map.is_none() && material.textures().is_empty()
        })
    }

    /// True if a material is a mix, so that [`MaterialTable::resolve`] needs a number.
    #[must_use]
    pub fn is_mix(&self, id: MaterialId) -> bool {
        matches!(self.materials[id.0 as usize].surface, Surface::Mix(_))
    }

    /// The material that a path hits at a point: for a mix the part selected by `u`, uniform in [0, 1), and recursively its parts; other
    /// materials are returned unchanged.
    #[must_use]
    pub fn resolve(&self, mut id: MaterialId, lookup: &Lookup, mut u: f32) -> MaterialId {
        while let Surface::Mix(parts) = &self.materials[id.0 as usize].surface {
            (id, u) = material::choose(parts, parts.weight.at(&self.textures, lookup), u);
        }
        id
    }

    /// The shading normal of a material at a point: the point's own, or bent by a normal map about unit tangents along u and v (render
    /// frame). Without tangents the normal is unchanged. The id is a resolved one.
    #[must_use]
    pub fn shading_normal(
        &self,
        id: MaterialId,
        lookup: &Lookup,
        point: &SurfacePoint,
        tangents: Option<[Vec3; 2]>,
    ) -> Vec3 {
        match (self.materials[id.0 as usize].normal_map, tangents) {
            (Some(map), Some(tangents)) => map.at(&self.textures, lookup, point.shading_normal, tangents),
            _ => point.shading_normal,
        }
    }

    /// A material's scattering at a point, for a path's wavelengths, seen from its `front` or its back. Panics on a mix:
    /// [`MaterialTable::resolve`] it first.
    #[must_use]
    pub fn bsdf<const N: usize>(
        &self,
        id: MaterialId,
        lookup: &Lookup,
        front: bool,
        wavelengths: &Wavelengths<N>,
    ) -> Bsdf<'_, N> {
        self.widened_bsdf(id, lookup, front, 0.0, wavelengths)
    }

    /// The same with microfacets of a roughness α of at least `min_alpha`: those of metals, coats, glass and paint, with the energy tables
    /// of their own roughness. Other lobes are unchanged.
    #[must_use]
    #[inline(always)]
    pub(crate) fn widened_bsdf<const N: usize>(
        &self,
        id: MaterialId,
        lookup: &Lookup,
        front: bool,
        min_alpha: f32,
        wavelengths: &Wavelengths<N>,
    ) -> Bsdf<'_, N> {
        let point = ShadingPoint { min_alpha, ..self.point(lookup, front, wavelengths) };
        self.materials[id.0 as usize].surface.resolve(&point)
    }

    /// The same if [`MaterialTable::is_diffuse_only`].
    #[inline(always)]
    pub(crate) fn diffuse_bsdf<const N: usize>(&self, id: MaterialId, wavelengths: &Wavelengths<N>) -> Bsdf<'_, N> {
        match &self.materials[id.0 as usize].surface {
            Surface::Diffuse(Reflectance::Spectrum(spectrum)) => {
                Bsdf::Diffuse(DiffuseBsdf { reflectance: spectrum.sample(wavelengths) })
            }
            _ => Bsdf::Absorber,
        }
    }

    fn point<'p, const N: usize>(
        &'p self,
        lookup: &'p Lookup,
        front: bool,
        wavelengths: &'p Wavelengths<N>,
    ) -> ShadingPoint<'p, N> {
        ShadingPoint { textures: &self.textures, lookup, front, wavelengths, min_alpha: 0.0 }
    }
}
