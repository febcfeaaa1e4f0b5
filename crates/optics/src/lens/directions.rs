//! Viewing directions of sensor points, as directions and angles.

use etendue_core::maths::f64::atan2;
use glam::{DVec2, DVec3};

use super::Lens;
use crate::overlap::PRINCIPAL_NM;

impl Lens {
    /// The angle between the directions seen at two sensor points, rad; `None` if one has no direction. The horizontal field of view is that between
    /// the centres of the image's left and right edges.
    #[must_use]
    pub fn angle_between_rad(&self, a_mm: DVec2, b_mm: DVec2) -> Option<f64> {
        let (a, b) = (self.direction(a_mm)?, self.direction(b_mm)?);
        Some(atan2(a.cross(b).length(), a.dot(b)))
    }

    /// Tangents X/Z and Y/Z of the chief ray of a sensor point, clipped or not; `None` beyond the distortion's fold, and for a ray that points
    /// sideways or back.
    #[must_use]
    pub fn tangent(&self, sensor_mm: DVec2) -> Option<DVec2> {
        let direction = self.direction(sensor_mm)?;
        (direction.z > 0.0).then(|| direction.truncate() / direction.z)
    }

    /// [`Lens::direction`] at a wavelength, for a lens with added lateral colour. (A prescription's own is traced ray by ray; its chief rays here are
    /// those of 587.56 nm.)
    #[must_use]
    pub fn direction_at(&self, sensor_mm: DVec2, nm: f64) -> Option<DVec3> {
        each!(self,
            lens => Some((lens.properties.ideal_at(sensor_mm, nm)? / self.principal_distance_mm()).extend(1.0)),
            Prescription(lens) => lens.direction(sensor_mm),
            RayTransfer(lens) => lens.direction(sensor_mm),
            Calibrated(lens) => lens.direction_at(sensor_mm, nm),
            Telecentric(_) => Some(DVec3::Z),
        )
    }

    /// The direction (of any length) of the chief ray of a sensor point, clipped or not; `None` if there is none.
    #[must_use]
    pub fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        self.direction_at(sensor_mm, PRINCIPAL_NM)
    }
}
