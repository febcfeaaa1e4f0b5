//! A number over a surface: one for all of it, or a channel of a texture.

use super::MaterialError;
use crate::textures::{Channel, ImageTexture, Lookup, TextureId};

/// A number, dimensionless: a roughness, an opacity, the share of a mix.
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
    /// The factor as a roughness α: a number must lie in 0 to 1. Textures are looked at when the material_table has them.
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
