//! Reflectance as a parameter: one spectrum, or colours of a texture.

use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::{Spectrum, upsample};

use crate::textures::{ImageTexture, Lookup, TextureId};

/// A reflectance, 0 to 1 at every wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum Reflectance {
    /// The same everywhere.
    Spectrum(Spectrum),
    /// Linear sRGB colours of a texture, made reflectances by three basis spectra: r·Bᵣ + g·B_g + b·B_b. Linear, so
    /// filtering colours is filtering spectra.
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
