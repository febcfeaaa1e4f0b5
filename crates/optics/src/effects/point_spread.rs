//! The point-spread functions that there are.

use super::Canvas;
use super::convolve::Field;
use super::operation_counts::OperationCounts;
use super::psf::{Psf, Ready};
use super::spread_image::{ReadyImage, SpreadImage};
use core::fmt;
use etendue_core::{Bands, EffectStatus};
use glam::DVec2;

/// A point-spread function.
#[derive(Clone, PartialEq)]
pub enum PointSpread {
    /// Of an aperture.
    Aperture(Psf),
    /// From a picture.
    Image(SpreadImage),
}

impl fmt::Debug for PointSpread {
    /// That of its member.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Aperture(psf) => psf.fmt(f),
            Self::Image(image) => image.fmt(f),
        }
    }
}

impl PointSpread {
    pub(super) fn status(spread: Option<&Self>) -> EffectStatus {
        match spread {
            None => EffectStatus::LeftOut("no [effects.psf] is described".to_owned()),
            Some(Self::Aperture(psf)) => psf.status(),
            Some(Self::Image(image)) => image.status(),
        }
    }

    /// Columns and rows that light is spread over.
    pub(super) fn reach_px(&self, pitch_mm: DVec2) -> [usize; 2] {
        match self {
            Self::Aperture(psf) => psf.reach_px(pitch_mm),
            Self::Image(image) => image.reach_px(pitch_mm),
        }
    }

    /// What it has to do on so many pictures a band.
    pub(super) fn operation_counts(&self, canvas: &Canvas, bands: Bands, pictures: f64) -> OperationCounts {
        match self {
            Self::Aperture(psf) => psf.operation_counts(canvas, bands, pictures),
            Self::Image(image) => image.operation_counts(canvas, bands, pictures),
        }
    }

    /// The function made ready for a film and the wavelengths of a range.
    pub(super) fn ready(&self, canvas: &Canvas, range_nm: (f64, f64)) -> ReadySpread {
        match self {
            Self::Aperture(psf) => ReadySpread::Aperture(Box::new(psf.ready(canvas, range_nm))),
            Self::Image(image) => ReadySpread::Image(Box::new(image.ready(canvas))),
        }
    }
}

/// A point-spread function of a film.
#[derive(Debug)]
pub(super) enum ReadySpread {
    /// Of an aperture.
    Aperture(Box<Ready>),
    /// From a picture.
    Image(Box<ReadyImage>),
}

impl ReadySpread {
    /// The film's light and variance in a band.
    pub(super) fn apply(&self, band_nm: (f64, f64), light: &Field, variance: Option<&Field>) -> (Field, Option<Field>) {
        match self {
            Self::Aperture(ready) => ready.apply(band_nm, light, variance),
            Self::Image(ready) => ready.apply(band_nm, light, variance),
        }
    }
}
