//! A thin lens: refraction in one plane, perfect imaging of the plane in focus, a finite pupil.
//!
//! The lens is a flat disc of diameter f/N and is both pupils. The sensor stands at the image distance of the lens
//! equation, c = f F/(F − f) for a focus distance F, so that close focus costs light (the bellows factor) by geometry alone.
//! The weight is the exact τ ∫ cos θ cos θ′ / d² dA over the disc, sampled uniformly by area; its mean is Foote's form
//! factor. On the axis at infinity focus E = π τ L / (1 + 4N²): the **flat-disc convention** tan θ′ = 1/2N (a lens that obeys
//! the sine condition would give π τ L / 4N²).
//!
//! All rays of a sensor point meet in the point of the plane in focus that its chief ray meets. With a distortion the
//! chief ray is the ideal point's, and the disc is seen from the sensor point itself. Left out: aberrations, dispersion,
//! diffraction, and a mount that clips.

use super::focus::{Conjugates, PupilSize};
use super::paraxial_properties::ParaxialProperties;
use crate::error::OpticsError;
use crate::pupil::{Pencil, PupilView, concentric_disc};
use crate::wavelength::PRINCIPAL_NM;
use etendue_core::ray::PupilRay;
use glam::DVec2;

/// What a thin lens is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinParameters {
    /// Focal length, mm.
    pub focal_length_mm: f64,
    /// f-number N: focal length over the diameter of the lens disc.
    pub f_number: f64,
    /// Distance of the plane in focus from the lens, m; more than the focal length, and infinity is legal.
    pub focus_distance_m: f64,
    /// Transmittance, (0, 1].
    pub transmittance: f64,
}

/// A thin lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Thin {
    pub(super) properties: ParaxialProperties,
    parameters: ThinParameters,
    pub(super) conjugates: Conjugates,
    pub(super) size: PupilSize,
}

impl Thin {
    /// A thin lens.
    ///
    /// # Errors
    /// Where a parameter is outside its range or the focus distance not beyond the focal length.
    pub fn new(parameters: ThinParameters) -> Result<Self, OpticsError> {
        let size = PupilSize::new(parameters.focal_length_mm, parameters.f_number)?;
        let conjugates = Conjugates::new(parameters.focal_length_mm, 1.0, parameters.focus_distance_m)?;
        Ok(Self { properties: ParaxialProperties::new(parameters.transmittance)?, parameters, conjugates, size })
    }

    /// What the lens was made of.
    #[must_use]
    pub fn parameters(&self) -> &ThinParameters {
        &self.parameters
    }

    pub(super) fn ray(&self, sensor_mm: DVec2, pupil: DVec2, nm: f64) -> Option<PupilRay> {
        self.through(sensor_mm, concentric_disc(pupil), nm)
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        self.through(sensor_mm, DVec2::ZERO, PRINCIPAL_NM)
    }

    /// The ray through the point `q` of the unit disc.
    fn through(&self, sensor_mm: DVec2, q: DVec2, nm: f64) -> Option<PupilRay> {
        let point_mm = q * self.size.entrance_radius_mm;
        let weight_sr = self.properties.transmittance * self.view().weight_sr(sensor_mm, point_mm);
        Some(self.pencil(sensor_mm, nm)?.ray(point_mm, weight_sr))
    }

    pub(super) fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        if self.properties.ideal(sensor_mm).is_none() {
            return 0.0;
        }
        self.properties.transmittance * self.view().projected_solid_angle_sr(sensor_mm)
    }

    fn view(&self) -> PupilView {
        PupilView { distance_mm: self.conjugates.principal_distance_mm, radius_mm: self.size.entrance_radius_mm }
    }

    fn pencil(&self, sensor_mm: DVec2, nm: f64) -> Option<Pencil> {
        let tangent = self.properties.ideal_at(sensor_mm, nm)? / self.conjugates.principal_distance_mm;
        Some(Pencil { tangent, inverse_focus_per_mm: self.conjugates.inverse_focus_per_mm })
    }
}
