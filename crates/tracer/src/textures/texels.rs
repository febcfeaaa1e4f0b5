//! Texels as files hold them, read as linear light.

use core::ops::{Add, Mul};

use etendue_spectra::colour::{self, XYZ_FROM_SRGB};
use glam::Vec3;

/// The texels of an image, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// One byte per channel, sRGB-encoded (IEC 61966-2-1).
    Srgb8(Vec<[u8; 3]>),
    /// One byte per channel, linear: 255 is 1.
    Linear8(Vec<[u8; 3]>),
    /// Linear numbers.
    Float(Vec<[f32; 3]>),
}

/// Encoding of the texels of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TexelEncoding {
    /// [`Texels::Srgb8`].
    Srgb8,
    /// [`Texels::Linear8`].
    Linear8,
    /// [`Texels::Float`].
    Float,
}

impl TexelEncoding {
    /// The linear values of bytes; `None` for texels that are no bytes.
    pub(super) fn table(self) -> Option<Box<[f32; 256]>> {
        match self {
            Self::Srgb8 => Some(table(colour::decode_byte)),
            Self::Linear8 => Some(table(|i| f32::from(i) / 255.0)),
            Self::Float => None,
        }
    }
}

impl Texels {
    /// Adds more of the same kind at the end.
    ///
    /// # Panics
    /// If they are of another kind.
    pub fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::Srgb8(all), Self::Srgb8(more)) | (Self::Linear8(all), Self::Linear8(more)) => all.extend(more),
            (Self::Float(all), Self::Float(more)) => all.extend(more),
            _ => panic!("texels of two kinds in one picture"),
        }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::Srgb8(t) | Self::Linear8(t) => t.len(),
            Self::Float(t) => t.len(),
        }
    }
}

/// Value of a texel: a colour, or a number.
pub(super) trait Texel: Copy + Add<Output = Self> + Mul<f32, Output = Self> {
    /// Its encoding in bytes in files.
    type Bytes: Copy + Clone + core::fmt::Debug;
    /// Zero.
    const NOTHING: Self;
    /// The value of bytes, by a table of the linear values of a byte.
    fn decoded(bytes: Self::Bytes, linear: &[f32; 256]) -> Self;
    /// Linear interpolation: `self` at `t` = 0, `other` at 1.
    fn towards(self, other: Self, t: f32) -> Self;
}

impl Texel for Vec3 {
    type Bytes = [u8; 3];
    const NOTHING: Self = Self::ZERO;

    fn decoded(bytes: [u8; 3], linear: &[f32; 256]) -> Self {
        Self::from(bytes.map(|b| linear[usize::from(b)]))
    }

    fn towards(self, other: Self, t: f32) -> Self {
        self.lerp(other, t)
    }
}

impl Texel for f32 {
    type Bytes = u8;
    const NOTHING: Self = 0.0;

    fn decoded(byte: u8, linear: &[f32; 256]) -> Self {
        linear[usize::from(byte)]
    }

    fn towards(self, other: Self, t: f32) -> Self {
        self + (other - self) * t
    }
}

/// Texels with the tables to decode them.
#[derive(Clone, Debug)]
pub(super) enum Store<T: Texel> {
    Bytes { texels: Vec<T::Bytes>, linear: Box<[f32; 256]> },
    Float(Vec<T>),
}

impl Store<Vec3> {
    pub(super) fn new(texels: Texels) -> Self {
        match texels {
            Texels::Srgb8(texels) => Self::Bytes { texels, linear: table(colour::decode_byte) },
            Texels::Linear8(texels) => Self::Bytes { texels, linear: table(|i| f32::from(i) / 255.0) },
            Texels::Float(texels) => Self::Float(texels.into_iter().map(Vec3::from).collect()),
        }
    }
}

impl Store<f32> {
    /// Numbers of 0 to 1 in bytes.
    pub(super) fn from_bytes(texels: Vec<u8>) -> Self {
        Self::Bytes { texels, linear: table(|i| f32::from(i) / 255.0) }
    }
}

impl<T: Texel> Store<T> {
    /// Memory of the texels, bytes.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Bytes { texels, .. } => size_of_val(texels.as_slice()),
            Self::Float(texels) => size_of_val(texels.as_slice()),
        }
    }

    pub(super) fn get(&self, i: usize) -> T {
        match self {
            Self::Bytes { texels, linear } => T::decoded(texels[i], linear),
            Self::Float(texels) => texels[i],
        }
    }
}

fn table(decode: impl Fn(u8) -> f32) -> Box<[f32; 256]> {
    Box::new(core::array::from_fn(|i| decode(i as u8)))
}

/// Channel of an image that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    Red,
    Green,
    Blue,
    /// Opacity of a texel; 1 for images without alpha.
    Alpha,
    /// The luminance of the linear colour, 1 for white; for a grey image, its grey.
    Luminance,
}

impl Channel {
    /// The channel of a colour.
    pub(super) fn value(self, [r, g, b]: [f32; 3]) -> f32 {
        match self {
            Self::Red => r,
            Self::Green => g,
            Self::Blue => b,
            Self::Alpha => 1.0,
            Self::Luminance => {
                let [wr, wg, wb] = XYZ_FROM_SRGB[1].map(|w| w as f32);
                // Rounding must not raise white above 1.
                (wr * r + wg * g + wb * b).clamp(r.min(g).min(b), r.max(g).max(b))
            }
        }
    }
}

/// Error of a texture.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// The texels do not fill the image.
    #[error("the texture has {actual} texels, but its size is {width} × {height}; correct its size")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Number of texels given.
        actual: usize,
    },
    /// A texel is not a finite number.
    #[error("texel {texel} of the texture is not a finite number; correct the file")]
    NonFinite {
        /// Index of the texel, by rows from the top.
        texel: usize,
    },
    /// The size or sharpness of a projection from three sides is out of range.
    #[error("triplanar mapping requires a size above 0 m and a sharpness of 1 to 64")]
    Projection,
    /// Scale or offset are not finite numbers.
    #[error("the texture's scale and offset must be finite numbers")]
    Placement,
}

/// Error of an image in tiles.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TiledError {
    /// Error of any image.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A tile cannot be written or read; text for the user.
    #[error("{0}")]
    Tiles(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_keeps_greys_and_weighs_colours() {
        for grey in [0.0, 0.2, 1.0, 1.0_f32.next_down()] {
            assert_eq!(Channel::Luminance.value([grey; 3]), grey);
        }
        // Y of the primaries: IEC 61966-2-1 with this crate's white, 0.2127, 0.7152, 0.0722.
        assert!((Channel::Luminance.value([0.0, 1.0, 0.0]) - 0.7152).abs() < 1e-4);
        assert_eq!(Channel::Blue.value([0.1, 0.2, 0.3]), 0.3);
    }
}
