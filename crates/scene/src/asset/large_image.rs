//! Images too large for memory: their properties without pixels, and access to the pixels.

use etendue_core::storage::BlockStore;
use std::fmt::Debug;
use std::sync::Arc;

use super::{ColourMatrix, ImagePixels};

/// Pixel format, one for each variant of [`ImagePixels`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelFormat {
    /// One channel of 8 bits.
    Gray8,
    /// One channel of 16 bits.
    Gray16,
    /// Three channels of 8 bits.
    Rgb8,
    /// Four channels of 8 bits, the last of them opacity.
    Rgba8,
    /// Three floating-point channels.
    Rgb32F,
    /// Four floating-point channels, the last of them opacity.
    Rgba32F,
}

impl PixelFormat {
    /// True if there is opacity.
    #[must_use]
    pub fn has_opacity(self) -> bool {
        matches!(self, Self::Rgba8 | Self::Rgba32F)
    }

    /// True if a channel is a byte.
    #[must_use]
    pub fn is_bytes(self) -> bool {
        matches!(self, Self::Gray8 | Self::Rgb8 | Self::Rgba8)
    }

    /// Bytes of a pixel in memory.
    #[must_use]
    pub fn bytes(self) -> u32 {
        match self {
            Self::Gray8 => 1,
            Self::Gray16 => 2,
            Self::Rgb8 => 3,
            Self::Rgba8 => 4,
            Self::Rgb32F => 12,
            Self::Rgba32F => 16,
        }
    }
}

/// Receives rows of an image; its error ends the reading.
pub type RowReceiver<'a> = &'a mut dyn FnMut(&ImagePixels) -> Result<(), String>;

/// Reads the pixels of an image, any number of times.
pub trait PixelRows: Debug + Send + Sync {
    /// Passes all rows from the top, whole rows at a time.
    ///
    /// # Errors
    /// The error of the file, in the words of reading a small image; or the error of `take`.
    fn read(&self, take: RowReceiver<'_>) -> Result<(), String>;
}

/// An image whose pixels stay in its file.
#[derive(Clone, Debug)]
pub struct LargeImage {
    /// Width, px.
    pub width: u32,
    /// Height, px.
    pub height: u32,
    /// Pixel format.
    pub format: PixelFormat,
    /// Conversion from the file's colours to Rec. 709; `None` if they are Rec. 709.
    pub to_rec_709: Option<ColourMatrix>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
    /// Pixels, with the colours of the file.
    pub rows: Arc<dyn PixelRows>,
}

/// Storage of the texels of large images, with a limited number in memory.
#[derive(Clone, Debug)]
pub struct TexelStore {
    /// Stores tiles of texels.
    pub blocks: Arc<dyn BlockStore>,
    /// Maximum bytes of tiles in memory at a time.
    pub memory_bytes: u64,
}
