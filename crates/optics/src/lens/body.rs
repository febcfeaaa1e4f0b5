//! What every lens has: a transmittance, and perhaps a radial distortion.

use crate::error::OpticsError;
use etendue_projection::RadialDistortion;
use glam::DVec2;

/// Transmittance and distortion of a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Body {
    /// Transmittance τ, the same at every wavelength.
    pub(crate) transmittance: f64,
    /// Radial distortion; `None` for a rectilinear lens.
    pub(crate) distortion: Option<RadialDistortion>,
}

impl Body {
    pub(crate) fn new(transmittance: f64) -> Result<Self, OpticsError> {
        if transmittance > 0.0 && transmittance <= 1.0 {
            Ok(Self { transmittance, distortion: None })
        } else {
            Err(OpticsError::Transmittance { value: transmittance })
        }
    }

    /// The ideal point of an observed one, mm.
    pub(crate) fn ideal(&self, observed_mm: DVec2) -> Option<DVec2> {
        self.distortion.map_or(Some(observed_mm), |d| d.ideal(observed_mm))
    }

    /// The observed point of an ideal one, mm.
    pub(crate) fn observed(&self, ideal_mm: DVec2) -> Option<DVec2> {
        self.distortion.map_or(Some(ideal_mm), |d| d.observed(ideal_mm))
    }

    /// Ideal area for one unit of observed area at an observed point.
    pub(crate) fn ideal_area_per_observed(&self, observed_mm: DVec2) -> Option<f64> {
        self.distortion.map_or(Some(1.0), |d| d.ideal_area_per_observed(observed_mm.length()))
    }
}
