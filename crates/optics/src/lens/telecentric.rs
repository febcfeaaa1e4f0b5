//! A parallel (orthographic) camera: every pixel looks along the axis, from its own place.
//!
//! The ideal of a lens that is telecentric on the side of the scene, with everything sharp: all its pencils have the same
//! working f-number N on the sensor's side, so E = π τ L/(4 N²) over the whole picture (small-pupil limit). Sizes do not
//! depend on distance: a length in the picture is the width of the field over that of the picture times as long. The camera's
//! position is the middle of a plane across the axis from which the rays begin; it sees nothing behind that plane.

use super::paraxial_properties::ParaxialProperties;
use crate::error::OpticsError;
use crate::range::{f_number, positive};
use core::f64::consts::PI;
use etendue_core::ray::PupilRay;
use glam::{DVec2, DVec3};

/// What a telecentric camera is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelecentricParameters {
    /// Length in the scene that one millimetre of the sensor sees, m.
    pub metres_per_mm: f64,
    /// f-number N on the sensor's side.
    pub f_number: f64,
    /// Transmittance, (0, 1].
    pub transmittance: f64,
}

/// A telecentric camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telecentric {
    parameters: TelecentricParameters,
    weight_sr: f64,
}

impl Telecentric {
    /// A telecentric camera.
    ///
    /// # Errors
    /// Where a parameter is outside its range.
    pub fn new(parameters: TelecentricParameters) -> Result<Self, OpticsError> {
        positive("field_width_m", parameters.metres_per_mm)?;
        let n = f_number(parameters.f_number)?;
        let transmittance = ParaxialProperties::new(parameters.transmittance)?.transmittance;
        Ok(Self { parameters, weight_sr: transmittance * PI / (4.0 * n * n) })
    }

    /// What it was made of.
    #[must_use]
    pub fn parameters(&self) -> &TelecentricParameters {
        &self.parameters
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> PupilRay {
        let origin_m = (sensor_mm * self.parameters.metres_per_mm).extend(0.0);
        PupilRay { origin_m, direction: DVec3::Z, weight_sr: self.weight_sr }
    }
}
