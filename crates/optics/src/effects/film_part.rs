//! The part of a point spread applied by the film: all of it, or the tails beyond a core that displaced samples; and the width of the function.

use etendue_core::WavelengthRange;
use glam::DVec2;

use super::core_table::{CoreBuilder, core_share};
use super::{band::BandLimited, error::EffectsError, kernel::Kernel};

/// The part of a point spread that a film applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmPart {
    /// All of it.
    Whole,
    /// The part beyond its core: the film's samples were displaced by the core ([`super::SampleSpread`]).
    Tails,
}

/// A kernel during accumulation of mass.
#[derive(Debug)]
pub(super) enum KernelBuilder {
    Whole(Box<BandLimited>),
    /// The tails are smooth: bilinear weights preserve them. They are convolved with the core once more, which is narrow compared with them.
    Tails(Kernel),
}

impl KernelBuilder {
    pub(super) fn new(part: FilmPart, reach: [usize; 2]) -> Self {
        match part {
            FilmPart::Whole => Self::Whole(Box::new(BandLimited::zeros(reach))),
            FilmPart::Tails => Self::Tails(Kernel::zeros(reach)),
        }
    }

    /// Adds a mass at `offset_px` from the centre.
    pub(super) fn deposit(&mut self, offset_px: DVec2, mass: f64) {
        match self {
            Self::Whole(band) => band.deposit(offset_px, mass),
            Self::Tails(kernel) => {
                let core = mass * core_share(offset_px);
                kernel.add(0, 0, core);
                kernel.deposit(offset_px, mass - core);
            }
        }
    }

    /// The kernel, its sum one.
    pub(super) fn kernel(self) -> Kernel {
        match self {
            Self::Whole(band) => band.kernel(),
            Self::Tails(kernel) => {
                let sum = kernel.sum();
                kernel.scaled(1.0 / sum)
            }
        }
    }
}

/// Width of a point-spread function on the pixels of a film, at the centre of the image at 555 nm; for tables over the field where they are widest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpreadWidth {
    /// Fraction of the light by which samples can be displaced: all of it within a pixel, none beyond 2.5 px, along rows and columns.
    pub core: f64,
    /// Maximum modulation error of a kernel on whole pixels, at up to half a cycle per pixel.
    pub film_error: f64,
    /// True if its width depends on the wavelength.
    pub scales: bool,
}

impl SpreadWidth {
    /// Measures a function that deposits light: positions, px, and fractions.
    pub(super) fn new(reach: [usize; 2], scales: bool, deposit: impl FnOnce(&mut dyn FnMut(DVec2, f64))) -> Self {
        let mut core = CoreBuilder::default();
        let (mut all, mut band) = (0.0, BandLimited::zeros(reach));
        deposit(&mut |offset_px: DVec2, mass: f64| {
            all += mass;
            core.deposit(offset_px, mass);
            band.deposit(offset_px, mass);
        });
        Self { core: core.sum() / all, film_error: band.worst_error(), scales }
    }

    /// The wider core and the larger error of two.
    pub(super) fn worse(self, other: Self) -> Self {
        Self {
            core: self.core.min(other.core),
            film_error: self.film_error.max(other.film_error),
            scales: self.scales || other.scales,
        }
    }
}

/// Minimum light in the core for displacing samples: the film then applies the core to the tails once more, and the extra blur is invisible.
const MIN_CORE: f64 = 0.8;
/// Maximum modulation error accepted from the film if samples add no noise: the function is the same at all wavelengths.
const MAX_FILM_ERROR: f64 = 0.01;
/// The same if they add noise. Diffraction by itself reaches 0.061, at half a cycle per pixel along the diagonals.
const MAX_FILM_ERROR_OF_BANDS: f64 = 0.065;

/// Method of spreading light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpreadMethod {
    /// Pixels of the film: no noise, but contrast is lost if the function is about as narrow as a pixel or narrower.
    Film,
    /// Displaced samples, with the film for the tails: exact for any width, with some more noise.
    Samples,
}

impl SpreadMethod {
    /// The requested method. By default, samples if the function is narrow and the film's error would exceed 0.01, or 0.065 where samples add noise.
    pub(super) fn choose(requested: Option<Self>, width: SpreadWidth) -> Result<Self, EffectsError> {
        let is_narrow = width.core >= MIN_CORE;
        let limit = if width.scales { MAX_FILM_ERROR_OF_BANDS } else { MAX_FILM_ERROR };
        match requested {
            Some(Self::Samples) if !is_narrow => Err(EffectsError::WideCore { core: width.core, least: MIN_CORE }),
            Some(requested) => Ok(requested),
            None if is_narrow && width.film_error > limit => Ok(Self::Samples),
            None => Ok(Self::Film),
        }
    }
}

pub(super) const MM_PER_NM: f64 = 1e-6;
pub(super) const NM_PER_UM: f64 = 1e3;
/// Maximum distance of wavelengths of a band, nm.
const STEP_NM: f64 = 10.0;

/// The centres of the equal parts of a band, none wider than the step.
pub(super) fn mid_wavelengths(band: WavelengthRange) -> impl Iterator<Item = f64> {
    let parts = (band.width_nm() / STEP_NM).ceil().max(1.0);
    (0..parts as usize).map(move |part| band.low_nm + band.width_nm() * (part as f64 + 0.5) / parts)
}
