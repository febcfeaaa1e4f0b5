//! Image-related quantities of a lens: scale, pupils, blur.

use super::{Lens, paraxial_properties::PupilSize};
use crate::pupil::MM;

impl Lens {
    /// Image size over object size in the plane in focus; 0 at infinity focus and if everything is sharp, except for a telecentric camera, whose
    /// scale is constant.
    #[must_use]
    pub fn magnification(&self) -> f64 {
        match self {
            Self::Pinhole(_) => 0.0,
            Self::Calibrated(lens) => {
                lens.parameters().focus_distance_m.map_or(0.0, |focus_m| lens.focal_length_mm() * MM / focus_m)
            }
            Self::Telecentric(lens) => MM / lens.parameters().metres_per_mm,
            Self::Thin(lens) => lens.conjugates.magnification,
            Self::Thick(lens) => lens.conjugates.magnification,
            Self::Prescription(lens) => lens.prescription().magnification(),
            Self::RayTransfer(lens) => lens.conjugates().magnification,
        }
    }

    /// Working f-number on the axis, 1/(2 tan θ′): grows with close focus (the bellows factor).
    #[must_use]
    pub fn working_f_number(&self) -> f64 {
        match self {
            Self::Telecentric(_) => self.f_number(),
            _ => self.f_number() * self.principal_distance_mm() / self.focal_length_mm(),
        }
    }

    /// Distance from the exit pupil to the sensor, mm: the principal distance for a pinhole, a thin lens and a calibrated camera, infinite for a
    /// telecentric camera.
    #[must_use]
    pub fn exit_pupil_distance_mm(&self) -> f64 {
        match self {
            Self::Pinhole(_) | Self::Thin(_) | Self::Calibrated(_) | Self::Telecentric(_) => {
                self.principal_distance_mm()
            }
            Self::Thick(lens) => lens.sensor_position_mm() - lens.exit_pupil_position_mm(),
            Self::Prescription(lens) => lens.prescription().exit_distance_mm().abs(),
            Self::RayTransfer(lens) => lens.exit_pupil_distance_mm(),
        }
    }

    /// Radius of the entrance pupil on the axis, m; 0 if everything is sharp.
    #[must_use]
    pub fn entrance_pupil_radius_m(&self) -> f64 {
        match self {
            Self::Pinhole(_) | Self::Telecentric(_) => 0.0,
            Self::Calibrated(lens) => lens.pupil_radius_mm() * MM,
            Self::Thin(lens) => lens.size.entrance_radius_mm * MM,
            Self::Thick(lens) => lens.size.entrance_radius_mm * MM,
            Self::Prescription(lens) => lens.prescription().paraxial().entrance_radius_mm * MM,
            Self::RayTransfer(lens) => lens.entrance_radius_mm() * MM,
        }
    }

    /// The sensor's z coordinate in the camera frame, m: negative if it lies behind the entrance pupil. For a calibrated camera it is assumed a focal
    /// length behind; for a telecentric camera it is unknown.
    #[must_use]
    pub fn sensor_plane_m(&self) -> f64 {
        match self {
            Self::Pinhole(_) | Self::Thin(_) | Self::Calibrated(_) | Self::Telecentric(_) => {
                -self.principal_distance_mm() * MM
            }
            Self::Thick(lens) => (lens.entrance_pupil_position_mm() - lens.sensor_position_mm()) * MM,
            Self::RayTransfer(lens) => lens.sensor_plane_m(),
            Self::Prescription(lens) => {
                (lens.prescription().paraxial().entrance_pupil_position_mm - lens.prescription().sensor_position_mm())
                    * MM
            }
        }
    }

    /// Diameter on the sensor (on the axis, mm) of the blur of a point at depth `depth_m` (along z, from the entrance
    /// pupil; infinity is legal).
    #[must_use]
    pub fn circle_of_confusion_mm(&self, depth_m: f64) -> f64 {
        match self {
            Self::Pinhole(_) | Self::Telecentric(_) => 0.0,
            Self::Calibrated(lens) => {
                let focus_m = lens.parameters().focus_distance_m.unwrap_or(f64::INFINITY);
                2.0 * lens.pupil_radius_mm() * lens.focal_length_mm() * MM * (1.0 / depth_m - 1.0 / focus_m).abs()
            }
            Self::Thin(lens) => lens.conjugates.circle_of_confusion_mm(lens.size.entrance_radius_mm, depth_m),
            Self::Thick(lens) => lens.conjugates.circle_of_confusion_mm(lens.size.entrance_radius_mm, depth_m),
            Self::RayTransfer(lens) => lens.conjugates().circle_of_confusion_mm(lens.entrance_radius_mm(), depth_m),
            Self::Prescription(lens) => {
                lens.conjugates().circle_of_confusion_mm(self.entrance_pupil_radius_m() / MM, depth_m)
            }
        }
    }

    /// The focus distance at which infinity blurs to a circle of `circle_mm`, m; 0 if everything is sharp.
    #[must_use]
    pub fn hyperfocal_m(&self, circle_mm: f64) -> f64 {
        match self {
            Self::Pinhole(_) | Self::Telecentric(_) => 0.0,
            Self::Calibrated(lens) => 2.0 * lens.pupil_radius_mm() * lens.focal_length_mm() * MM / circle_mm,
            Self::Thin(lens) => lens.size.hyperfocal_m(self.focal_length_mm(), 1.0, circle_mm),
            Self::Thick(lens) => lens.size.hyperfocal_m(self.focal_length_mm(), lens.pupil_magnification, circle_mm),
            Self::RayTransfer(lens) => {
                let size = PupilSize { entrance_radius_mm: lens.entrance_radius_mm() };
                size.hyperfocal_m(lens.focal_length_mm(), lens.pupil_magnification(), circle_mm)
            }
            Self::Prescription(lens) => {
                let p = lens.prescription().paraxial();
                let size = PupilSize { entrance_radius_mm: p.entrance_radius_mm };
                size.hyperfocal_m(p.focal_length_mm.abs(), p.pupil_magnification(), circle_mm)
            }
        }
    }
}
