//! Parameters of materials, which are numbers, spectra or textures: their values at a point, and their checks.

use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::{Spectrum, upsample};

use super::error::MaterialError;
use crate::textures::{Channel, ImageTexture, Lookup, TextureId};

/// A parameter that may be a texture. A model lists its own once: both the checked ranges and the textures with a computed footprint follow
/// from the list.
#[derive(Clone, Copy, Debug)]
pub(super) enum Parameter<'a> {
    /// A reflectance or transmittance, 0 to 1 at every wavelength.
    Reflectance(&'a Reflectance),
    /// A number, 0 to 1, and its name in error messages, with its article.
    Factor(Factor, &'static str),
}

impl Parameter<'_> {
    pub(super) fn alpha(alpha: Factor) -> Self {
        Self::Factor(alpha, "a roughness α")
    }

    /// Its texture, if it is one.
    pub(super) fn texture(&self) -> Option<TextureId> {
        match self {
            Self::Reflectance(reflectance) => reflectance.texture(),
            Self::Factor(factor, _) => factor.texture(),
        }
    }
}

/// A number, dimensionless: a roughness, an opacity, the weight of a mix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// The same everywhere.
    Number(f32),
    /// A channel of a texture.
    Texture(TextureId, Channel),
}

impl From<f64> for Factor {
    fn from(value: f64) -> Self {
        Self::Number(value as f32)
    }
}

impl Factor {
    /// The factor as a roughness α: a number must lie in 0 to 1. Textures are checked when the material_table has them.
    pub(super) fn checked_alpha(self) -> Result<Self, MaterialError> {
        match self {
            Self::Number(alpha) if !(0.0..=1.0).contains(&alpha) => {
                Err(MaterialError::Roughness { alpha: f64::from(alpha) })
            }
            _ => Ok(self),
        }
    }

    pub(super) fn at(&self, textures: &[ImageTexture], lookup: &Lookup) -> f32 {
        match self {
            Self::Number(value) => *value,
            Self::Texture(id, channel) => textures[id.0 as usize].channel(lookup, *channel),
        }
    }

    /// The texture that it reads, if any.
    #[must_use]
    pub fn texture(&self) -> Option<TextureId> {
        match self {
            Self::Number(_) => None,
            Self::Texture(id, _) => Some(*id),
        }
    }
}

/// A reflectance, 0 to 1 at every wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum Reflectance {
    /// The same everywhere.
    Spectrum(Spectrum),
    /// Linear sRGB colours of a texture, converted to reflectances by three basis spectra: r·Bᵣ + g·B_g + b·B_b. The conversion is linear,
    /// so filtering colours is filtering spectra.
    Texture(TextureId),
}

impl Reflectance {
    /// The texture that it reads, if any.
    #[must_use]
    pub fn texture(&self) -> Option<TextureId> {
        match self {
            Self::Spectrum(_) => None,
            Self::Texture(id) => Some(*id),
        }
    }

    #[inline(always)]
    pub(super) fn at<const N: usize>(
        &self,
        textures: &[ImageTexture],
        lookup: &Lookup,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        match self {
            Self::Spectrum(spectrum) => spectrum.sample(wavelengths),
            Self::Texture(id) => upsample::reflectance(textures[id.0 as usize].sample(lookup), wavelengths),
        }
    }
}

/// A point of a surface, and the wavelengths of the path that hit it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadingPoint<'p, const N: usize> {
    /// All textures, by their ids.
    pub(super) textures: &'p [ImageTexture],
    /// Place and width of texture look-ups.
    pub(super) lookup: &'p Lookup,
    /// True if the viewer is on the side that the geometric normal points to: the outside of a solid.
    pub(super) front: bool,
    /// Wavelengths of the path, nm.
    pub(super) wavelengths: &'p Wavelengths<N>,
    /// Minimum roughness α of microfacets here: 0 if they are not widened.
    pub(super) min_alpha: f32,
}

impl<const N: usize> ShadingPoint<'_, N> {
    /// A reflectance here, 0 to 1.
    #[inline(always)]
    pub(super) fn reflectance(&self, reflectance: &Reflectance) -> Spectral<N> {
        reflectance.at(self.textures, self.lookup, self.wavelengths)
    }

    /// The roughness α of microfacets here whose own roughness is `alpha`.
    #[inline(always)]
    pub(super) fn widened(&self, alpha: f32) -> f32 {
        alpha.max(self.min_alpha)
    }

    /// A number over the surface here, 0 to 1.
    #[inline(always)]
    pub(super) fn factor(&self, factor: Factor) -> f32 {
        factor.at(self.textures, self.lookup)
    }
}

/// Rounding in the basis spectra may raise white a little over 1.
pub(super) const WHITE: f32 = 1.0 + 1e-4;

/// One material's parameters against the textures of its table.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureCheck<'a> {
    /// Index of the material in the table, for error messages.
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

    /// Maximum of a reflectance: a spectrum itself; for a texture its brightest colour at all wavelengths. The parameter has been checked.
    pub(super) fn brightest(&self, reflectance: &Reflectance) -> Spectrum {
        match reflectance {
            Reflectance::Spectrum(spectrum) => spectrum.clone(),
            Reflectance::Texture(id) => Spectrum::constant(f64::from(self.textures[id.0 as usize].range().1)),
        }
    }

    /// The texture of a quantity that only texture coordinates can place.
    pub(super) fn uv_texture(&self, what: &'static str, id: TextureId) -> Result<&'a ImageTexture, MaterialError> {
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
