//! What every paraxial lens has: a transmittance, and perhaps a radial distortion and lateral colour.

use super::lateral_colour::LateralColour;
use crate::error::OpticsError;
use core::fmt::{self, Debug, Formatter};
use etendue_projection::RadialDistortion;
use glam::DVec2;
use std::sync::Arc;

/// Transmittance, distortion and lateral colour of a lens.
#[derive(Clone, PartialEq)]
pub(crate) struct ParaxialProperties {
    /// Transmittance τ, the same at every wavelength.
    pub(crate) transmittance: f64,
    /// Radial distortion; `None` for a rectilinear lens.
    pub(crate) distortion: Option<RadialDistortion>,
    /// Image size by wavelength; `None` where all colours are alike.
    pub(crate) lateral_colour: Option<Arc<LateralColour>>,
}

/// A lens without lateral colour does not mention it.
impl Debug for ParaxialProperties {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("ParaxialProperties");
        text.field("transmittance", &self.transmittance).field("distortion", &self.distortion);
        if let Some(colour) = &self.lateral_colour {
            text.field("lateral_colour", colour);
        }
        text.finish()
    }
}

impl ParaxialProperties {
    pub(crate) fn new(transmittance: f64) -> Result<Self, OpticsError> {
        if transmittance > 0.0 && transmittance <= 1.0 {
            Ok(Self { transmittance, distortion: None, lateral_colour: None })
        } else {
            Err(OpticsError::Transmittance { value: transmittance })
        }
    }

    /// The ideal point of an observed one, mm, at 587.56 nm.
    pub(crate) fn ideal(&self, observed_mm: DVec2) -> Option<DVec2> {
        self.distortion.map_or(Some(observed_mm), |d| d.ideal(observed_mm))
    }

    /// The ideal point of an observed one, mm, at a wavelength.
    pub(crate) fn ideal_at(&self, observed_mm: DVec2, nm: f64) -> Option<DVec2> {
        self.ideal(self.lateral_colour.as_ref().map_or(observed_mm, |colour| observed_mm / colour.at(nm)))
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
