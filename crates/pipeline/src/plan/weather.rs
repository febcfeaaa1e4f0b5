//! Rain or snow of a plan, and the weather that is laid over a stored radiance image.

use etendue_spectra::Spectrum;
use etendue_tracer::media::Medium;
use etendue_tracer::precipitation::{Field, Resolution};

/// Rain or snow.
#[derive(Clone, Debug, PartialEq)]
pub struct Precipitation {
    /// All drops or flakes.
    pub field: Field,
    /// The place of its medium among the plan's media.
    pub medium: usize,
    /// Distance from a camera within which nothing falls, m.
    pub clear_m: f64,
    /// Part of a pixel's width from which on a drop or flake is modelled by itself.
    pub smallest_px: f64,
    /// How many are modelled at most.
    pub most: u64,
}

impl Precipitation {
    /// What a camera resolves whose pixels are `pixel_rad` wide in an exposure of `exposure_s`.
    #[must_use]
    pub fn resolution(&self, pixel_rad: f64, exposure_s: f64) -> Resolution {
        let Self { smallest_px, clear_m, .. } = *self;
        Resolution { pixel_rad, smallest_px, clear_m, most: self.most as f64, exposure_s }
    }
}

/// The radiance of fog without end.
#[derive(Clone, Debug, PartialEq)]
pub enum Airlight {
    /// The same everywhere, W·m⁻²·sr⁻¹·nm⁻¹.
    Uniform(Spectrum),
    /// The mean of what the image shows of the sky, from the horizon up to a height, rad.
    Sky {
        /// The height.
        elevation_rad: f64,
    },
}

/// Weather over an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// The radiance of fog without end.
    pub airlight: Airlight,
    /// Fog, of which only the extinction counts, and the medium of what falls.
    pub media: Vec<Medium>,
    /// Rain or snow.
    pub falling: Option<Falling>,
}

/// Rain or snow over a moment's image.
#[derive(Clone, Debug, PartialEq)]
pub struct Falling {
    /// What falls.
    pub precipitation: Precipitation,
    /// How long it is exposed, s.
    pub exposure_s: f64,
}
