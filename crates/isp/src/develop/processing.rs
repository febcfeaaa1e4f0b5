//! The settings of development.

use crate::correction::{Defects, Shading, ShadingError};
use crate::detail::{DetailError, NoiseReduction, UnsharpMask};
use crate::paper::{self, FilterError};
use crate::raw::{BlackLevel, Mosaic, Tile};
use crate::{colour_matrix::ColourMatrix, demosaic::Demosaic, tone::ToneCurve, white_balance::WhiteBalance};

/// Conversion of camera colours to display colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Colour {
    pub white_balance: WhiteBalance,
    /// From white-balanced camera colours to linear sRGB.
    pub matrix: ColourMatrix,
}

/// Steps of the development of a raw image, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Processing {
    /// Source of the black level.
    pub black_level: BlackLevel,
    /// Defective pixels.
    pub defects: Defects,
    /// Shading correction.
    pub shading: Option<Shading>,
    /// Colour interpolation.
    pub demosaic: Demosaic,
    pub noise_reduction: Option<NoiseReduction>,
    /// Colour; `None` for a mono image, and only for one.
    pub colour: Option<Colour>,
    /// Digital gain after colour, above 0; 1 shows the white level as white.
    pub exposure_gain: f64,
    /// Encoding of linear light.
    pub tone: ToneCurve,
    /// Sharpening of the encoded image.
    pub sharpening: Option<UnsharpMask>,
    /// The paper's filters, those of linear light first.
    pub image_filters: Vec<paper::Filter>,
}

impl Processing {
    /// The minimum: the stated black level, bilinear demosaic, colour, the sRGB curve.
    #[must_use]
    pub fn plain(colour: Option<Colour>) -> Self {
        Self {
            black_level: BlackLevel::Stated,
            defects: Defects::default(),
            shading: None,
            demosaic: Demosaic::Bilinear,
            noise_reduction: None,
            colour,
            exposure_gain: 1.0,
            tone: ToneCurve::Srgb,
            sharpening: None,
            image_filters: Vec::new(),
        }
    }

    /// Checks that the settings are legal and fit images of this mosaic and size.
    ///
    /// # Errors
    /// If a number is out of range or settings and mosaic contradict each other.
    pub fn check(&self, mosaic: &Mosaic, width: usize, height: usize) -> Result<(), DevelopError> {
        if !(self.exposure_gain.is_finite() && self.exposure_gain > 0.0) {
            return Err(DevelopError::ExposureGain(self.exposure_gain));
        }
        check_defects(&self.defects, width, height)?;
        self.shading.as_ref().map_or(Ok(()), Shading::check)?;
        self.noise_reduction.as_ref().map_or(Ok(()), NoiseReduction::check)?;
        self.sharpening.as_ref().map_or(Ok(()), UnsharpMask::check)?;
        paper::check(&self.image_filters)?;
        match (mosaic, &self.colour) {
            (Mosaic::Mono, None) => Ok(()),
            (Mosaic::Mono, Some(_)) => Err(DevelopError::ColourOfMono),
            (Mosaic::Tile(_), None) => Err(DevelopError::NoColour),
            (Mosaic::Tile(tile), Some(colour)) => {
                self.check_demosaic(mosaic, width, height)?;
                check_colour(tile, colour)
            }
        }
    }

    fn check_demosaic(&self, mosaic: &Mosaic, width: usize, height: usize) -> Result<(), DevelopError> {
        let bayer = matches!(mosaic, Mosaic::Tile(tile) if tile.is_bayer());
        if self.demosaic != Demosaic::Bilinear && !bayer {
            return Err(DevelopError::NotBayer);
        }
        let minimum = self.demosaic.min_size_px(mosaic);
        let fits = width.min(height) >= minimum;
        if fits { Ok(()) } else { Err(DevelopError::TooSmall { width, height, least: minimum }) }
    }
}

fn check_defects(defects: &Defects, width: usize, height: usize) -> Result<(), DevelopError> {
    if let Some(threshold) = defects.outlier_threshold.filter(|t| !(t.is_finite() && *t > 0.0)) {
        return Err(DevelopError::OutlierThreshold(threshold));
    }
    let outside = |[x, y]: &&[u32; 2]| *x as usize >= width || *y as usize >= height;
    match defects.map.iter().find(outside) {
        Some([x, y]) => Err(DevelopError::DefectOutside { x: *x, y: *y, width, height }),
        None => Ok(()),
    }
}

fn check_colour(tile: &Tile, colour: &Colour) -> Result<(), DevelopError> {
    let channels = |settings: usize| match tile.filters().len() {
        mosaic if mosaic == settings => Ok(()),
        mosaic => Err(DevelopError::Channels { mosaic, settings }),
    };
    channels(colour.matrix.channels())?;
    let WhiteBalance::Gains(gains) = &colour.white_balance else { return Ok(()) };
    channels(gains.len())?;
    let legal = gains.iter().all(|g| g.is_finite() && *g >= 1.0);
    if legal { Ok(()) } else { Err(DevelopError::WhiteBalance(gains.clone())) }
}

/// Error of development.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DevelopError {
    /// No range between black and white.
    #[error("the white level is {white} DN and the black level {black} DN: white must be above black")]
    Levels {
        /// Black level, DN.
        black: f64,
        /// White level, DN.
        white: f64,
    },
    /// Optical-black pixels requested, but there are none.
    #[error(
        "the black level is to be measured on shielded pixels, but the image has none: use the stated level, or a sensor with optical-black rows"
    )]
    NoOpticalBlack,
    /// A mapped defect outside the image.
    #[error(
        "the defective pixel at column {x}, row {y} lies outside the image of {width} × {height} pixels: remove it"
    )]
    DefectOutside {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Columns of the image.
        width: usize,
        /// Rows of the image.
        height: usize,
    },
    /// An invalid threshold.
    #[error("the outlier threshold of defect correction is {0}, but a fraction of the range above 0 is needed")]
    OutlierThreshold(f64),
    /// An invalid shading table.
    #[error(transparent)]
    Shading(#[from] ShadingError),
    /// Invalid gains.
    #[error("white balance is {0:?}, but finite gains of at least 1 are needed: divide them by the smallest")]
    WhiteBalance(Vec<f64>),
    /// Settings for another number of channels.
    #[error(
        "the mosaic has {mosaic} channels, but white balance and colour matrix are for {settings}: give one gain and one column for each channel"
    )]
    Channels {
        /// Channels of the mosaic.
        mosaic: usize,
        /// Channels of the settings.
        settings: usize,
    },
    /// A demosaic method for Bayer tiles used with another tile.
    #[error("this demosaicing method needs a Bayer tile, which the mosaic is not: use the bilinear one")]
    NotBayer,
    /// An invalid exposure gain.
    #[error("exposure_gain is {0}, but a finite number above 0 is needed")]
    ExposureGain(f64),
    /// Noise reduction or sharpening with a number out of range.
    #[error(transparent)]
    Detail(#[from] DetailError),
    /// A filter of the paper that cannot be applied.
    #[error(transparent)]
    Paper(#[from] FilterError),
    /// Colour settings for an image without colour.
    #[error("a mono image has no colour to balance: leave white balance and colour matrix out")]
    ColourOfMono,
    /// No colour settings for an image with colour.
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

/// Checks that black is below white.
pub(super) fn check_levels(black: f64, white: f64) -> Result<(), DevelopError> {
    let legal = black.is_finite() && white.is_finite() && white > black;
    if legal { Ok(()) } else { Err(DevelopError::Levels { black, white }) }
}
