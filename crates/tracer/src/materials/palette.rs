//! The materials and textures of a world, checked once.

use etendue_core::{Spectral, Wavelengths};

use super::{Bsdf, DiffuseBsdf, Emission, Material, MaterialError, Reflectance, Surface};
use crate::MaterialId;
use crate::textures::{ImageTexture, Lookup, TextureId};

/// Materials and textures. Immutable; every texture that a material names is here, every reflectance lies in 0–1.
#[derive(Clone, Debug, Default)]
pub struct Palette {
    materials: Vec<Material>,
    textures: Vec<ImageTexture>,
}

impl Palette {
    /// Materials, in the order of their ids, and the textures they name.
    ///
    /// # Errors
    /// Where a material names no texture, reflects more than arrives, or emits what is not light.
    pub fn new(materials: Vec<Material>, textures: Vec<ImageTexture>) -> Result<Self, MaterialError> {
        for (i, material) in materials.iter().enumerate() {
            match &material.surface {
                Surface::Diffuse(reflectance) => check_reflectance(i, reflectance, &textures)?,
                Surface::Coated(coated) => check_reflectance(i, &coated.base, &textures)?,
                Surface::Absorber | Surface::Conductor(_) => {}
            }
            if let Some(emission) = &material.emission {
                check_emission(i, emission, &textures)?;
            }
        }
        Ok(Self { materials, textures })
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

    /// A material's emission. Panics on an id of another palette.
    #[must_use]
    pub fn emission(&self, id: MaterialId) -> Option<&Emission> {
        self.materials[id.0 as usize].emission.as_ref()
    }

    /// Radiance (W·m⁻²·sr⁻¹·nm⁻¹) of a glowing side at a point.
    pub(crate) fn radiance<const N: usize>(
        &self,
        emission: &Emission,
        lookup: &Lookup,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        emission.at(&self.textures, lookup, wavelengths)
    }

    /// A material's scattering at a point, for a path's wavelengths. Panics on an id of another palette.
    #[must_use]
    pub fn bsdf<const N: usize>(&self, id: MaterialId, lookup: &Lookup, wavelengths: &Wavelengths<N>) -> Bsdf<'_, N> {
        match &self.materials[id.0 as usize].surface {
            Surface::Absorber => Bsdf::Absorber,
            Surface::Diffuse(r) => {
                Bsdf::Diffuse(DiffuseBsdf { reflectance: r.at(&self.textures, lookup, wavelengths) })
            }
            Surface::Conductor(conductor) => Bsdf::Conductor(conductor.resolve(wavelengths)),
            Surface::Coated(coated) => {
                Bsdf::Coated(coated.resolve(coated.base.at(&self.textures, lookup, wavelengths)))
            }
        }
    }
}

/// Rounding in the basis spectra may take white a little over 1.
const WHITE: f32 = 1.0 + 1e-4;

fn check_reflectance(
    material: usize,
    reflectance: &Reflectance,
    textures: &[ImageTexture],
) -> Result<(), MaterialError> {
    let (low, high) = match reflectance {
        Reflectance::Spectrum(s) => (s.min_value(), s.max_value()),
        Reflectance::Texture(id) => find_texture(material, *id, textures)?.range(),
    };
    match [low, high].into_iter().find(|v| !(0.0..=WHITE).contains(v)) {
        Some(value) => Err(MaterialError::Reflectance { material, value }),
        None => Ok(()),
    }
}

fn check_emission(material: usize, emission: &Emission, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let (mut low, mut high) = (emission.radiance.min_value(), emission.radiance.max_value());
    if let Some(id) = emission.factor {
        let range = find_texture(material, id, textures)?.range();
        (low, high) = (low.min(range.0), high * range.1);
    }
    match [low, high].into_iter().find(|v| !(v.is_finite() && *v >= 0.0)) {
        Some(value) => Err(MaterialError::Radiance { material, value }),
        None => Ok(()),
    }
}

fn find_texture(material: usize, id: TextureId, textures: &[ImageTexture]) -> Result<&ImageTexture, MaterialError> {
    let unknown = MaterialError::UnknownTexture { material, texture: id.0, textures: textures.len() };
    textures.get(id.0 as usize).ok_or(unknown)
}
