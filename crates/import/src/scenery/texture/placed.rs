//! Textures of materials.

use super::super::projection::TextureBase;

/// Converted texture.
#[derive(Clone)]
pub(crate) enum KnownTexture {
    /// Constant.
    Even([f64; 3]),
    /// One of our textures, times a number.
    Picture {
        name: String,
        scale: f64,
        /// True if its number is its opacity, as for pbrt's images with one.
        has_alpha: bool,
    },
}

/// Texture of a material, and the source of its texture coordinates.
#[derive(Clone)]
pub(crate) struct PlacedTexture {
    pub(crate) texture: KnownTexture,
    pub(crate) base: TextureBase,
}

impl PlacedTexture {
    pub(crate) fn even(value: [f64; 3]) -> Self {
        Self { texture: KnownTexture::Even(value), base: TextureBase::Surface }
    }

    pub(crate) fn picture(name: String, scale: f64, has_alpha: bool, base: TextureBase) -> Self {
        Self { texture: KnownTexture::Picture { name, scale, has_alpha }, base }
    }
}

/// Use of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TextureUse {
    /// Reflectances, 0 to 1.
    Colours,
    /// Numbers, 0 to 1.
    Numbers,
    /// Square roots of numbers: pbrt's remapped roughness.
    SquareRoots,
}

impl TextureUse {
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Colours => "colours",
            Self::Numbers => "numbers",
            Self::SquareRoots => "square roots",
        }
    }

    /// Value for the use, before it is limited to 0 … 1.
    pub(crate) fn mapped(self, value: f64) -> f64 {
        if self == Self::SquareRoots { value.max(0.0).sqrt() } else { value }
    }
}
