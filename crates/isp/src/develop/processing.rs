//! The settings of development.

use super::DevelopError;
use crate::black_level::BlackLevel;
use crate::colour_matrix::ColourMatrix;
use crate::defects::Defects;
use crate::demosaic::Demosaic;
use crate::detail::{NoiseReduction, Unsharp};
use crate::mosaic::{Mosaic, Tile};
use crate::paper;
use crate::shading::Shading;
use crate::tone::ToneCurve;
use crate::white_balance::WhiteBalance;

/// How colours of a camera become those of a display.
#[derive(Clone, Debug, PartialEq)]
pub struct Colour {
    /// What makes grey grey.
    pub white_balance: WhiteBalance,
    /// From white-balanced camera colours to linear sRGB.
    pub matrix: ColourMatrix,
}

/// How a raw picture is developed, step by step in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Processing {
    /// What counts as no light.
    pub black_level: BlackLevel,
    /// Which pixels do not measure.
    pub defects: Defects,
    /// What makes an even light even.
    pub shading: Option<Shading>,
    /// How the colours between are found.
    pub demosaic: Demosaic,
    /// How noise is reduced.
    pub noise_reduction: Option<NoiseReduction>,
    /// Colour; `None` for a mono picture, and only for one.
    pub colour: Option<Colour>,
    /// Digital gain after colour, above 0; 1 shows the white level as white.
    pub exposure_gain: f64,
    /// How linear light is encoded.
    pub tone: ToneCurve,
    /// How the encoded picture is sharpened.
    pub sharpening: Option<Unsharp>,
    /// The paper's filters, those of linear light first.
    pub image_filters: Vec<paper::Filter>,
}

impl Processing {
    /// Nothing but what a picture needs: the stated black level, bilinear demosaic, colour, the sRGB curve.
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

    /// Whether the settings are legal and fit pictures of this mosaic and size.
    ///
    /// # Errors
    /// Where a number is out of range or settings and mosaic contradict each other.
    pub fn check(&self, mosaic: &Mosaic, width: usize, height: usize) -> Result<(), DevelopError> {
        if !(self.exposure_gain.is_finite() && self.exposure_gain > 0.0) {
            return Err(DevelopError::ExposureGain(self.exposure_gain));
        }
        check_defects(&self.defects, width, height)?;
        self.shading.as_ref().map_or(Ok(()), Shading::check)?;
        self.noise_reduction.as_ref().map_or(Ok(()), NoiseReduction::check)?;
        self.sharpening.as_ref().map_or(Ok(()), Unsharp::check)?;
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
        let least = self.demosaic.least_px(mosaic);
        let fits = width.min(height) >= least;
        if fits { Ok(()) } else { Err(DevelopError::TooSmall { width, height, least }) }
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
