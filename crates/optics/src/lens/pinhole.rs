//! A pinhole: every point of the scene is sharp, and a nominal f-number says how much light there is.
//!
//! Irradiance of the limit of small pupils: E = τ π L cos⁴ θ′ / (4N²), with θ′ the angle at which the pinhole is seen from
//! the sensor point itself (after distortion). All light passes through one point, so the pupil sample changes nothing. The
//! distance from sensor to pinhole is the focal length. Diffraction, which would make a real pinhole of this f-number
//! unsharp or a large one blurred, is left out.

use super::paraxial_properties::ParaxialProperties;
use crate::error::OpticsError;
use crate::pupil::{Pencil, PupilView};
use crate::range::{f_number, positive};
use crate::wavelength::PRINCIPAL_NM;
use etendue_core::ray::PupilRay;
use glam::DVec2;

/// What a pinhole is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeParameters {
    /// Distance from sensor to pinhole, mm.
    pub focal_length_mm: f64,
    /// Nominal f-number N: sets the irradiance, not the sharpness.
    pub f_number: f64,
    /// Transmittance, (0, 1].
    pub transmittance: f64,
}

/// A pinhole camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Pinhole {
    pub(super) properties: ParaxialProperties,
    parameters: PinholeParameters,
    /// The nominal pupil, used in the limit of small pupils only.
    pupil: PupilView,
}

impl Pinhole {
    /// A pinhole.
    ///
    /// # Errors
    /// Where a parameter is outside its range.
    pub fn new(parameters: PinholeParameters) -> Result<Self, OpticsError> {
        let distance_mm = positive("focal_length_mm", parameters.focal_length_mm)?;
        let radius_mm = distance_mm / (2.0 * f_number(parameters.f_number)?);
        let properties = ParaxialProperties::new(parameters.transmittance)?;
        Ok(Self { properties, parameters, pupil: PupilView { distance_mm, radius_mm } })
    }

    /// What the pinhole was made of.
    #[must_use]
    pub fn parameters(&self) -> &PinholeParameters {
        &self.parameters
    }

    pub(super) fn ray(&self, sensor_mm: DVec2, _pupil: DVec2, nm: f64) -> Option<PupilRay> {
        let tangent = self.properties.ideal_at(sensor_mm, nm)? / self.principal_distance_mm();
        let pencil = Pencil { tangent, inverse_focus_per_mm: 0.0 };
        Some(pencil.ray(DVec2::ZERO, self.properties.transmittance * self.pupil.weight_sr(sensor_mm, DVec2::ZERO)))
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        self.ray(sensor_mm, DVec2::ZERO, PRINCIPAL_NM)
    }

    pub(super) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        self.principal_ray(sensor_mm).map_or(0.0, |ray| ray.weight_sr)
    }

    pub(super) fn principal_distance_mm(&self) -> f64 {
        self.parameters.focal_length_mm
    }
}
