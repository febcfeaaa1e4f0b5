//! Texels as files hold them, read as linear light.

use etendue_spectra::colour;
use glam::Vec3;

/// The texels of a picture, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Bytes a channel, sRGB-encoded (IEC 61966-2-1).
    Srgb8(Vec<[u8; 3]>),
    /// Bytes a channel, linear: 255 is 1.
    Linear8(Vec<[u8; 3]>),
    /// Linear numbers.
    Float(Vec<[f32; 3]>),
}

impl Texels {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Srgb8(t) | Self::Linear8(t) => t.len(),
            Self::Float(t) => t.len(),
        }
    }
}

/// Texels with what it takes to read them.
#[derive(Clone, Debug)]
pub(super) enum Store {
    Bytes { texels: Vec<[u8; 3]>, linear: Box<[f32; 256]> },
    Float(Vec<[f32; 3]>),
}

impl Store {
    pub(super) fn new(texels: Texels) -> Self {
        match texels {
            Texels::Srgb8(texels) => Self::Bytes { texels, linear: table(colour::decode_byte) },
            Texels::Linear8(texels) => Self::Bytes { texels, linear: table(|i| f32::from(i) / 255.0) },
            Texels::Float(texels) => Self::Float(texels),
        }
    }

    pub(super) fn get(&self, i: usize) -> Vec3 {
        match self {
            Self::Bytes { texels, linear } => Vec3::from(texels[i].map(|b| linear[usize::from(b)])),
            Self::Float(texels) => Vec3::from(texels[i]),
        }
    }
}

fn table(decode: impl Fn(u8) -> f32) -> Box<[f32; 256]> {
    Box::new(core::array::from_fn(|i| decode(i as u8)))
}
