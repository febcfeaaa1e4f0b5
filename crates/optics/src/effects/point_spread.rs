//! The kinds of point-spread functions.

use core::fmt;

use etendue_core::{Bands, EffectStatus, WavelengthRange};
use glam::DVec2;

use super::convolve::{NumberField, OperationCounts};
use super::film_part::{FilmPart, SpreadWidth};
use super::psf::{PreparedPsf, Psf};
use super::spread_image::{PreparedImage, SpreadImage};
use super::spread_table::{PreparedTable, SpreadTable};
use super::{Canvas, sample_spread::SampleSpread};

/// Wavelength at which the width of a function is stated, nm.
const GREEN_NM: f64 = 555.0;

/// A point-spread function.
#[derive(Clone, PartialEq)]
pub enum PointSpread {
    Aperture(Psf),
    /// From an image.
    Image(SpreadImage),
    /// From tables over the field.
    Table(SpreadTable),
}

impl fmt::Debug for PointSpread {
    /// Delegates to the member.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Aperture(psf) => psf.fmt(f),
            Self::Image(image) => image.fmt(f),
            Self::Table(table) => table.fmt(f),
        }
    }
}

impl PointSpread {
    pub(super) fn status(spread: Option<&Self>) -> EffectStatus {
        match spread {
            None => EffectStatus::LeftOut("no [effects.psf] is described".to_owned()),
            Some(Self::Aperture(psf)) => psf.status(),
            Some(Self::Image(image)) => image.status(),
            Some(Self::Table(table)) => table.status(),
        }
    }

    /// Columns and rows over which light is spread.
    pub(super) fn reach_px(&self, pitch_mm: DVec2) -> [usize; 2] {
        match self {
            Self::Aperture(psf) => psf.reach_px(pitch_mm),
            Self::Image(image) => image.reach_px(pitch_mm),
            Self::Table(table) => table.reach_px(pitch_mm),
        }
    }

    /// Operation counts for the given number of images per band.
    pub(super) fn operation_counts(&self, canvas: &Canvas, bands: Bands, images: f64) -> OperationCounts {
        match self {
            Self::Aperture(psf) => psf.operation_counts(canvas, bands, images),
            Self::Image(image) => image.operation_counts(canvas, bands, images),
            Self::Table(table) => table.operation_counts(canvas, bands, images),
        }
    }

    /// The function prepared for a film and the wavelengths of a range.
    pub(super) fn prepare(&self, canvas: &Canvas, range: WavelengthRange, part: FilmPart) -> PreparedSpread {
        match self {
            Self::Aperture(psf) => PreparedSpread::Aperture(Box::new(psf.prepare(canvas, range, part))),
            Self::Image(image) => PreparedSpread::Image(Box::new(image.prepare(canvas, part))),
            Self::Table(table) => PreparedSpread::Table(Box::new(PreparedTable::new(table.clone(), canvas, part))),
        }
    }

    /// The cores by which samples are displaced, for the wavelengths of a range; `None` if they hold no light.
    pub(super) fn sample_spread(&self, canvas: &Canvas, range: WavelengthRange) -> Option<SampleSpread> {
        match self {
            Self::Aperture(psf) => psf.sample_spread(canvas, range),
            Self::Image(image) => image.sample_spread(canvas, range),
            Self::Table(table) => table.sample_spread(canvas, range),
        }
    }

    /// Width of the function on the pixels of a film.
    pub(super) fn width(&self, canvas: &Canvas) -> SpreadWidth {
        let reach = self.reach_px(canvas.pitch_mm());
        match self {
            Self::Aperture(psf) => SpreadWidth::new(reach, true, |to| psf.deposit_middle(canvas, GREEN_NM, to)),
            Self::Image(image) => {
                let scales = image.parameters().wavelength_nm.is_some();
                SpreadWidth::new(reach, scales, |to| image.deposit(canvas.pitch_mm(), GREEN_NM, to))
            }
            Self::Table(table) => table.width(canvas, GREEN_NM),
        }
    }
}

/// A point-spread function prepared for a film.
#[derive(Debug)]
pub(super) enum PreparedSpread {
    Aperture(Box<PreparedPsf>),
    /// From an image.
    Image(Box<PreparedImage>),
    /// From tables over the field.
    Table(Box<PreparedTable>),
}

impl PreparedSpread {
    /// The film's light and variance in a band.
    pub(super) fn apply(
        &self,
        band: WavelengthRange,
        light: &NumberField,
        variance: Option<&NumberField>,
    ) -> (NumberField, Option<NumberField>) {
        match self {
            Self::Aperture(ready) => ready.apply(band, light, variance),
            Self::Image(ready) => ready.apply(band, light, variance),
            Self::Table(ready) => ready.apply(band, light, variance),
        }
    }
}
