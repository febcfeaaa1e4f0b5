//! Rays of a sensor point, and their weights.

use etendue_core::ray::PupilRay;
use glam::{DVec2, DVec3};

use super::Lens;
use crate::prescription::trace::ApertureTest;

/// The ray of ground truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthRay {
    pub ray: PupilRay,
    /// True if the chief ray is clipped and this one goes through the centroid of the open part of the pupil instead.
    pub off_centre: bool,
}

impl Lens {
    /// The ray of a sensor point (mm) through a pupil sample in [0, 1)² at a wavelength; `None` if no light comes.
    #[must_use]
    pub fn ray(&self, sensor_mm: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<PupilRay> {
        each!(self,
            lens => lens.ray(sensor_mm, pupil, wavelength_nm),
            Prescription(lens) => lens.ray(sensor_mm, pupil, wavelength_nm),
            RayTransfer(lens) => lens.ray(sensor_mm, pupil, wavelength_nm),
            Calibrated(lens) => lens.ray(sensor_mm, pupil, wavelength_nm),
            Telecentric(lens) => Some(lens.principal_ray(sensor_mm)),
        )
    }

    /// The same with central obscurations ignored.
    pub(crate) fn unobscured_ray(&self, sensor_mm: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<PupilRay> {
        match self {
            Self::Prescription(lens) => lens.tested_ray(sensor_mm, pupil, wavelength_nm, ApertureTest::RimsOnly),
            _ => self.ray(sensor_mm, pupil, wavelength_nm),
        }
    }

    /// The ray of a sensor point through the centre of the entrance pupil, its weight that of the small-pupil limit; `None` if it is clipped or the
    /// sensor point has no image. A central obscuration does not stop it.
    #[must_use]
    pub fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        each!(self,
            lens => lens.principal_ray(sensor_mm),
            Prescription(lens) => lens.principal_ray(sensor_mm),
            RayTransfer(lens) => lens.principal_ray(sensor_mm),
            Calibrated(lens) => lens.principal_ray(sensor_mm),
            Telecentric(lens) => Some(lens.principal_ray(sensor_mm)),
        )
    }

    /// The ray of ground truth: the principal ray or, if that is clipped but light arrives, the ray through the centroid of the open part of the
    /// pupil. `None` if no light arrives.
    #[must_use]
    pub fn truth_ray(&self, sensor_mm: DVec2) -> Option<TruthRay> {
        if let Some(ray) = self.principal_ray(sensor_mm) {
            return Some(TruthRay { ray, off_centre: false });
        }
        match self {
            Self::Pinhole(_) | Self::Thin(_) | Self::RayTransfer(_) | Self::Calibrated(_) | Self::Telecentric(_) => {
                None
            }
            Self::Thick(lens) => lens.centroid_ray(sensor_mm).map(|ray| TruthRay { ray, off_centre: true }),
            Self::Prescription(lens) => lens.centroid_ray(sensor_mm).map(|ray| TruthRay { ray, off_centre: true }),
        }
    }

    /// The sensor point of a direction of the camera frame (any length), mm; `None` outside the field, beyond a fold, and for a telecentric camera,
    /// which sees a single direction. Clipping is ignored.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        let ideal_mm = || self.rectilinear().project(direction);
        each!(self,
            lens => lens.properties.observed(ideal_mm()?),
            Prescription(lens) => lens.project(direction),
            RayTransfer(lens) => lens.project(direction),
            Calibrated(lens) => lens.project(direction),
            Telecentric(_) => None,
        )
    }

    /// Irradiance of a sensor point per uniform radiance, sr; 0 if no light arrives.
    #[must_use]
    pub fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        each!(self,
            lens => lens.projected_solid_angle_sr(sensor_mm),
            Prescription(lens) => lens.projected_solid_angle_sr(sensor_mm),
            RayTransfer(lens) => lens.projected_solid_angle_sr(sensor_mm),
            Calibrated(lens) => lens.projected_solid_angle_sr(sensor_mm),
            Telecentric(lens) => lens.principal_ray(sensor_mm).weight_sr,
        )
    }

    /// True if a ray or its weight depends on the wavelength: dispersive glasses, coatings, a filter, lateral colour. A sample's ray then serves one
    /// wavelength only.
    #[must_use]
    pub fn disperses(&self) -> bool {
        let own = match self {
            Self::Prescription(lens) => lens.disperses(),
            Self::RayTransfer(lens) => lens.disperses(),
            _ => false,
        };
        own || self.lateral_colour().is_some()
    }

    /// True if the chief ray of a sensor point depends on the wavelength: lateral colour.
    #[must_use]
    pub fn spreads_colours(&self) -> bool {
        let own = match self {
            Self::Prescription(lens) => lens.prescription().disperses(),
            Self::RayTransfer(lens) => lens.disperses(),
            _ => false,
        };
        own || self.lateral_colour().is_some()
    }
}
