//! Precipitation of a plan, and the weather applied to a stored radiance image.

use etendue_spectra::Spectrum;
use etendue_tracer::media::Medium;
use etendue_tracer::precipitation::{CameraResolution, PrecipitationField};

/// Rain or snow.
#[derive(Clone, Debug, PartialEq)]
pub struct Precipitation {
    /// All drops or flakes.
    pub field: PrecipitationField,
    /// Index of its medium in the plan's media.
    pub medium: usize,
    /// Distance from a camera within which there are no drops or flakes, m.
    pub clear_m: f64,
    /// Minimum size of an individually modelled drop or flake, as a fraction of a pixel's width.
    pub smallest_px: f64,
    /// Maximum number of individually modelled drops or flakes.
    pub max_drops: u64,
}

impl Precipitation {
    /// Resolution of a camera with pixels of `pixel_rad` in an exposure of `exposure_s`.
    #[must_use]
    pub fn resolution(&self, pixel_rad: f64, exposure_s: f64) -> CameraResolution {
        let Self { smallest_px, clear_m, .. } = *self;
        CameraResolution {
            pixel_rad,
            min_size_px: smallest_px,
            clear_m,
            max_particles: self.max_drops as f64,
            exposure_s,
        }
    }
}

/// Radiance of infinitely deep fog.
#[derive(Clone, Debug, PartialEq)]
pub enum Airlight {
    /// Constant, W·m⁻²·sr⁻¹·nm⁻¹.
    Uniform(Spectrum),
    /// Mean of the image's sky from the horizon up to an elevation, rad.
    Sky { elevation_rad: f64 },
}

/// Weather applied to an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// Radiance of infinitely deep fog.
    pub airlight: Airlight,
    /// Fog, for which only the extinction is used, and the medium of the precipitation.
    pub media: Vec<Medium>,
    /// Rain or snow.
    pub falling: Option<PrecipitationExposure>,
}

/// Rain or snow over an instantaneous image.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecipitationExposure {
    pub precipitation: Precipitation,
    /// Exposure time, s.
    pub exposure_s: f64,
}
