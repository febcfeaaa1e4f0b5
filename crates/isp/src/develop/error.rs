//! Why a picture cannot be developed.

use crate::detail::DetailError;
use crate::paper::FilterError;
use crate::shading::ShadingError;

/// Why a picture cannot be developed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DevelopError {
    /// There is no range between black and white.
    #[error("the white level is {white} DN and the black level {black} DN: white must be above black")]
    Levels {
        /// Black level, DN.
        black: f64,
        /// White level, DN.
        white: f64,
    },
    /// Shielded pixels are asked for, and there are none.
    #[error(
        "the black level shall come from shielded pixels, but the picture has none: use the stated level, or a sensor with optical-black rows"
    )]
    NoOpticalBlack,
    /// A mapped defect beside the picture.
    #[error("the defective pixel at column {x}, row {y} lies outside the picture of {width} × {height} pixels")]
    DefectOutside {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Columns of the picture.
        width: usize,
        /// Rows of the picture.
        height: usize,
    },
    /// A threshold that is none.
    #[error("the outlier threshold of defect correction is {0}, but a share of the range above 0 is needed")]
    OutlierThreshold(f64),
    /// A shading table that is none.
    #[error(transparent)]
    Shading(#[from] ShadingError),
    /// Gains that are no gains.
    #[error("white balance is {0:?}, but finite gains of at least 1 are needed: divide them by the smallest")]
    WhiteBalance(Vec<f64>),
    /// Settings for another number of channels.
    #[error("the mosaic has {mosaic} channels, but white balance and colour matrix are for {settings}")]
    Channels {
        /// Channels of the mosaic.
        mosaic: usize,
        /// Channels of the settings.
        settings: usize,
    },
    /// A demosaic for Bayer tiles on another one.
    #[error("this demosaic is made for Bayer tiles, and the mosaic is none: use the bilinear one")]
    NotBayer,
    /// An exposure gain that is none.
    #[error("exposure_gain is {0}, but a finite number above 0 is needed")]
    ExposureGain(f64),
    /// Noise reduction or sharpening with a number out of range.
    #[error(transparent)]
    Detail(#[from] DetailError),
    /// A filter of the paper that cannot be applied.
    #[error(transparent)]
    Paper(#[from] FilterError),
    /// Colour settings for a picture without colour.
    #[error("a mono picture has no colour to balance: leave white balance and colour matrix out")]
    ColourOfMono,
    /// No colour settings for a picture with colour.
    #[error("a colour mosaic needs white balance and a colour matrix, but neither is given")]
    NoColour,
    /// Too few pixels to interpolate.
    #[error("a colour mosaic of {width} × {height} pixels cannot be demosaiced: at least {least} × {least} are needed")]
    TooSmall {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Columns and rows needed.
        least: usize,
    },
}

/// Black below white.
pub(super) fn check_levels(black: f64, white: f64) -> Result<(), DevelopError> {
    let legal = black.is_finite() && white.is_finite() && white > black;
    if legal { Ok(()) } else { Err(DevelopError::Levels { black, white }) }
}
