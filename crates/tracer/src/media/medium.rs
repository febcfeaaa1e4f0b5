//! A medium that scatters and absorbs: fog, haze, spray, smoke.
//!
//! At a point the extinction coefficient is β(λ) · (1 + a n), with n noise of mean zero. Its fraction `albedo` is scattered, by the phase function.
//! Left out: emission of the medium itself, and an albedo or a phase function that vary in space.

use std::sync::Arc;

use etendue_core::Motion;
use etendue_spectra::Spectrum;
use glam::DVec3;

use super::{noise::Noise, phase::Phase, shape::MediumRegion};

/// Error of a medium.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MediumError {
    /// An extinction is negative or too large.
    #[error("the extinction is {value} 1/m; it must be 0 to 1e6 at every wavelength")]
    Extinction {
        /// Value given, 1/m.
        value: f32,
    },
    /// An albedo is out of range.
    #[error("the albedo is {value}; it must be 0 to 1 at every wavelength")]
    Albedo {
        /// Value given.
        value: f32,
    },
    /// The motion takes a scale to zero.
    #[error("the medium's transform is not finite or has a scale of 0; correct it")]
    Transform,
}

/// Variation of a medium's density in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityVariation {
    /// The noise, in the world.
    pub noise: Noise,
    /// Deviation of the density at noise 1, as a fraction of the mean: 0 to 1.
    pub amplitude: f64,
    /// Drift velocity of the noise, m/s.
    pub wind_mps: DVec3,
}

/// Optical properties of a medium at its mean density.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MediumOptics {
    /// Extinction coefficient, 1/m.
    pub(super) extinction: Arc<Spectrum>,
    pub(super) albedo: Arc<Spectrum>,
    pub(super) phase: Arc<Phase>,
    /// Maximum extinction over wavelengths, 1/m.
    pub(super) max_per_m: f32,
}

impl MediumOptics {
    fn new(extinction: Spectrum, albedo: Spectrum, phase: Arc<Phase>) -> Self {
        let max_per_m = extinction.max_value();
        Self { extinction: Arc::new(extinction), albedo: Arc::new(albedo), phase, max_per_m }
    }

    /// The same if light scattered by the forward peak, a fraction f, counts as not scattered: β (1 − ω f), albedo ω (1 − f)/(1 − ω f).
    fn without_peak(&self) -> Self {
        let Some((fraction, phase)) = self.phase.without_peak() else { return self.clone() };
        let at = |of: &Spectrum, nm: f64| f64::from(of.at(nm as f32));
        let remaining = |nm: f64| 1.0 - at(&self.albedo, nm) * at(&fraction, nm);
        let extinction = Spectrum::from_fn(|nm| at(&self.extinction, nm) * remaining(nm));
        let albedo =
            Spectrum::from_fn(|nm| (at(&self.albedo, nm) * (1.0 - at(&fraction, nm)) / remaining(nm)).min(1.0));
        Self::new(extinction, albedo, Arc::new(phase))
    }
}

/// Treatment of the forward peaks of phase functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForwardPeak {
    /// Light is scattered by the phase function itself.
    Exact,
    /// Light within the forward peak counts as not scattered. Precipitation is left out.
    Unscattered,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    exact: MediumOptics,
    without_peak: MediumOptics,
    pub(super) unevenness: Option<DensityVariation>,
    pub(super) shape: MediumRegion,
    pub(super) to_world: Motion,
}

impl Medium {
    /// A medium of mean extinction coefficient `extinction` (1/m) and single-scattering `albedo` that fills a `shape`; `to_world`
    /// transforms the shape's frame to the world.
    ///
    /// # Errors
    /// If a number is out of range, or the motion flattens the shape.
    pub fn new(
        extinction: Spectrum,
        albedo: Spectrum,
        phase: impl Into<Arc<Phase>>,
        shape: MediumRegion,
        to_world: Motion,
    ) -> Result<Self, MediumError> {
        let faulty = |of: &Spectrum, maximum: f32| {
            [of.min_value(), of.max_value()].into_iter().find(|value| !(*value >= 0.0 && *value <= maximum))
        };
        if let Some(value) = faulty(&extinction, 1e6) {
            return Err(MediumError::Extinction { value });
        }
        if let Some(value) = faulty(&albedo, 1.0) {
            return Err(MediumError::Albedo { value });
        }
        let start = to_world.at(0.0);
        if !(start.is_finite() && start.matrix3.determinant() != 0.0) {
            return Err(MediumError::Transform);
        }
        let exact = MediumOptics::new(extinction, albedo, phase.into());
        let without_peak = exact.without_peak();
        Ok(Self { exact, without_peak, unevenness: None, shape, to_world })
    }

    /// The same, but absent for light that is traced without forward peaks: for media that deflect little light and absorb none.
    #[must_use]
    pub fn absent_without_peaks(self) -> Self {
        let MediumOptics { albedo, phase, .. } = &self.exact;
        let (albedo, phase) = (albedo.clone(), phase.clone());
        let without_peak =
            MediumOptics { extinction: Arc::new(Spectrum::constant(0.0)), albedo, phase, max_per_m: 0.0 };
        Self { without_peak, ..self }
    }

    #[inline(always)]
    pub(super) fn optics(&self, peak: ForwardPeak) -> &MediumOptics {
        match peak {
            ForwardPeak::Exact => &self.exact,
            ForwardPeak::Unscattered => &self.without_peak,
        }
    }

    /// Adds a non-uniform density.
    #[must_use]
    pub fn with_unevenness(self, unevenness: DensityVariation) -> Self {
        let unevenness = Some(unevenness).filter(|unevenness| unevenness.amplitude != 0.0);
        Self { unevenness, ..self }
    }

    /// Mean extinction coefficient, 1/m.
    #[must_use]
    pub fn extinction(&self) -> &Spectrum {
        &self.exact.extinction
    }

    /// Fraction of the extinction that is scattered.
    #[must_use]
    pub fn albedo(&self) -> &Spectrum {
        &self.exact.albedo
    }

    /// True if it moves, or its density variation drifts.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.to_world.as_constant().is_none() || self.unevenness.is_some_and(|of| of.wind_mps != DVec3::ZERO)
    }

    /// Density at a point of the world, m, at a simulated time, s, over its mean.
    #[inline]
    pub(super) fn density(&self, point_m: DVec3, time_s: f64) -> f64 {
        match &self.unevenness {
            None => 1.0,
            Some(DensityVariation { noise, amplitude, wind_mps }) => {
                1.0 + amplitude * noise.at(point_m - *wind_mps * time_s)
            }
        }
    }

    /// Maximum density over its mean.
    #[inline]
    pub(super) fn max_density(&self) -> f32 {
        self.unevenness.as_ref().map_or(1.0, |unevenness| 1.0 + unevenness.amplitude as f32)
    }
}
