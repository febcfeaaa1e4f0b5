//! Pictures that are too large to be held: what is known of them without their pixels, and how these are read.

use etendue_core::storage::BlockStore;
use std::fmt::Debug;
use std::sync::Arc;

use super::{ColourMatrix, ImagePixels};

/// Which of [`ImagePixels`] a picture's are.
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
    /// Whether there is opacity.
    #[must_use]
    pub fn has_opacity(self) -> bool {
        matches!(self, Self::Rgba8 | Self::Rgba32F)
    }

    /// Whether a channel is a byte.
    #[must_use]
    pub fn is_bytes(self) -> bool {
        matches!(self, Self::Gray8 | Self::Rgb8 | Self::Rgba8)
    }

    /// Bytes that a pixel takes in memory.
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

/// Takes rows of a picture; its error ends the reading.
pub type TakeRows<'a> = &'a mut dyn FnMut(&ImagePixels) -> Result<(), String>;

/// Reads a picture's pixels as often as it is asked to.
pub trait PixelRows: Debug + Send + Sync {
    /// Hands all rows over from the top, whole rows at a time.
    ///
    /// # Errors
    /// What is wrong with the file, in the words of reading a small picture; or the error of `take`.
    fn read(&self, take: TakeRows<'_>) -> Result<(), String>;
}

/// A picture whose pixels stay in its file.
#[derive(Clone, Debug)]
pub struct LargeImage {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What its pixels are.
    pub format: PixelFormat,
    /// What makes the file's colours those of Rec. 709; `None` where they are.
    pub to_rec_709: Option<ColourMatrix>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
    /// Its pixels, with colours as the file has them.
    pub rows: Arc<dyn PixelRows>,
}

/// Where the texels of large pictures are kept, and how many of them in memory.
#[derive(Clone, Debug)]
pub struct TexelStore {
    /// Keeps tiles of texels.
    pub blocks: Arc<dyn BlockStore>,
    /// Most bytes of tiles that are in memory at a time.
    pub memory_bytes: u64,
}
