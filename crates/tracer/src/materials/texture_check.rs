//! What the parameters of a material must be, textures included.

use etendue_spectra::Spectrum;

use super::error::MaterialError;
use super::factor::Factor;
use super::parameter::Parameter;
use super::reflectance::Reflectance;
use crate::textures::{Channel, ImageTexture, TextureId};

/// Rounding in the basis spectra may take white a little over 1.
pub(super) const WHITE: f32 = 1.0 + 1e-4;

/// One material's parameters against the textures of its table.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureCheck<'a> {
    /// The material's place in the table, for refusals.
    pub(super) material: usize,
    /// All textures, by their ids.
    pub(super) textures: &'a [ImageTexture],
}

impl<'a> TextureCheck<'a> {
    /// Refuses a parameter out of its range.
    pub(super) fn parameter(&self, parameter: Parameter<'_>) -> Result<(), MaterialError> {
        match parameter {
            Parameter::Reflectance(reflectance) => self.reflectance(reflectance),
            Parameter::Factor(factor, quantity) => self.factor(factor, quantity),
        }
    }

    /// A reflectance where it is greatest: a spectrum itself, of a texture its brightest colour at all wavelengths. The
    /// parameter has been checked.
    pub(super) fn brightest(&self, reflectance: &Reflectance) -> Spectrum {
        match reflectance {
            Reflectance::Spectrum(spectrum) => spectrum.clone(),
            Reflectance::Texture(id) => Spectrum::constant(f64::from(self.textures[id.0 as usize].range().1)),
        }
    }

    /// The texture of what only texture coordinates can place.
    pub(super) fn laid_by_uv(&self, what: &'static str, id: TextureId) -> Result<&'a ImageTexture, MaterialError> {
        let texture = self.find(id)?;
        if texture.needs_uv() { Ok(texture) } else { Err(MaterialError::Projected { material: self.material, what }) }
    }

    fn reflectance(&self, reflectance: &Reflectance) -> Result<(), MaterialError> {
        let (low, high) = match reflectance {
            Reflectance::Spectrum(spectrum) => (spectrum.min_value(), spectrum.max_value()),
            Reflectance::Texture(id) => self.find(*id)?.range(),
        };
        match [low, high].into_iter().find(|v| !(0.0..=WHITE).contains(v)) {
            Some(value) => Err(MaterialError::Reflectance { material: self.material, value }),
            None => Ok(()),
        }
    }

    fn factor(&self, factor: Factor, quantity: &'static str) -> Result<(), MaterialError> {
        let material = self.material;
        let (low, high) = match factor {
            Factor::Number(value) => (value, value),
            Factor::Texture(id, channel) => {
                let texture = self.find(id)?;
                if channel == Channel::Alpha && !texture.has_alpha() {
                    return Err(MaterialError::NoAlpha { material, texture: id.0 });
                }
                texture.channel_range(channel)
            }
        };
        match [low, high].into_iter().find(|v| !(0.0..=1.0).contains(v)) {
            Some(value) => Err(MaterialError::Factor { material, quantity, value }),
            None => Ok(()),
        }
    }

    fn find(&self, id: TextureId) -> Result<&'a ImageTexture, MaterialError> {
        let unknown =
            MaterialError::UnknownTexture { material: self.material, texture: id.0, textures: self.textures.len() };
        self.textures.get(id.0 as usize).ok_or(unknown)
    }
}
