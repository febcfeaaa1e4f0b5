//! A number over a surface: one for all of it, or a channel of a texture.

use crate::textures::{Channel, ImageTexture, Lookup, TextureId};

/// A number, dimensionless: a roughness, an opacity, the share of a mix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// The same everywhere.
    Number(f32),
    /// A channel of a texture.
    Texture(TextureId, Channel),
}

impl Factor {
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
