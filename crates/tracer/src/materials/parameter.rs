//! What a model reads at each point of its surface.

use super::factor::Factor;
use super::reflectance::Reflectance;
use crate::textures::TextureId;

/// A parameter that may be a texture. A model lists its own once: the ranges that are checked and the textures whose footprint is
/// computed both follow from the list.
#[derive(Clone, Copy, Debug)]
pub(super) enum Parameter<'a> {
    /// A reflectance or transmittance, 0 to 1 at every wavelength.
    Reflectance(&'a Reflectance),
    /// A number, 0 to 1, and the words for it in refusals, with their article.
    Factor(Factor, &'static str),
}

impl Parameter<'_> {
    /// A roughness α.
    pub(super) fn alpha(alpha: Factor) -> Self {
        Self::Factor(alpha, "a roughness α")
    }

    /// The texture that it is, if it is one.
    pub(super) fn texture(&self) -> Option<TextureId> {
        match self {
            Self::Reflectance(reflectance) => reflectance.texture(),
            Self::Factor(factor, _) => factor.texture(),
        }
    }
}
