//! How a sensor's raw pictures are developed, and written.

use etendue_isp::{Mosaic, Processing};

/// How raw becomes a picture.
#[derive(Clone, Debug)]
pub struct Development {
    /// Which pixel measures which colour.
    pub mosaic: Mosaic,
    /// Every step.
    pub processing: Processing,
    /// How the picture is written.
    pub format: PictureFormat,
}

/// How a picture is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Without loss.
    Png {
        /// Bits of a channel: 8, or 10 to 16 in a file of 16.
        bits: u32,
    },
    /// With loss, 8 bits.
    Jpeg {
        /// 1 to 100.
        quality: u8,
    },
}

impl PictureFormat {
    /// The extension of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png { .. } => "png",
            Self::Jpeg { .. } => "jpg",
        }
    }

    /// Bits of a channel.
    #[must_use]
    pub fn bits(self) -> u32 {
        match self {
            Self::Png { bits } => bits,
            Self::Jpeg { .. } => 8,
        }
    }
}
