//! First-order focusing: where the sensor stands, and how far a point out of focus spreads.
//!
//! With focal length f, pupil magnification m_p (exit over entrance diameter) and the plane in focus at F from the
//! **entrance pupil**, the image's magnification is |m| = 1/(F/f − 1/m_p) and the principal distance, by which tangents in
//! object space become lengths on the sensor, is c = f (1 + |m|/m_p). The exit pupil is at m_p c from the sensor. For pupils
//! in the principal planes m_p = 1 and these are the lens equation.

use crate::error::OpticsError;
use crate::pupil::MM;
use crate::range::positive;

/// Plane in focus and sensor plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Conjugates {
    /// Image size over object size, positive; 0 at infinity focus.
    pub(crate) magnification: f64,
    /// c, mm.
    pub(crate) principal_distance_mm: f64,
    /// Inverse distance of the plane in focus from the entrance pupil, 1/mm; 0 at infinity.
    pub(crate) inverse_focus_per_mm: f64,
}

impl Conjugates {
    pub(crate) fn new(focal_mm: f64, pupil_magnification: f64, focus_m: f64) -> Result<Self, OpticsError> {
        let inverse_focus_per_mm = MM / focus_m;
        let least_mm = focal_mm / pupil_magnification;
        // Written with the inverse so that infinity is no special case: |m| = f/F / (1 − f/(m_p F)).
        let room = 1.0 - least_mm * inverse_focus_per_mm;
        if focus_m.is_nan() || focus_m <= 0.0 || room <= 0.0 {
            return Err(OpticsError::FocusTooNear { focus_m, least_m: least_mm * MM });
        }
        let magnification = focal_mm * inverse_focus_per_mm / room;
        let principal_distance_mm = focal_mm * (1.0 + magnification / pupil_magnification);
        Ok(Self { magnification, principal_distance_mm, inverse_focus_per_mm })
    }

    /// Diameter (mm on the sensor, on the axis) of the blur of a point at depth `depth_m` through an entrance pupil:
    /// 2 a c |1/z − 1/F|.
    pub(crate) fn circle_of_confusion_mm(&self, entrance_radius_mm: f64, depth_m: f64) -> f64 {
        2.0 * entrance_radius_mm * self.principal_distance_mm * (MM / depth_m - self.inverse_focus_per_mm).abs()
    }
}

/// The entrance pupil that an f-number means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PupilSize {
    /// Radius f/2N, mm.
    pub(crate) entrance_radius_mm: f64,
}

impl PupilSize {
    pub(crate) fn new(focal_length_mm: f64, f_number: f64) -> Result<Self, OpticsError> {
        let focal_mm = positive("focal_length_mm", focal_length_mm)?;
        Ok(Self { entrance_radius_mm: focal_mm / (2.0 * crate::range::f_number(f_number)?) })
    }

    /// The focus distance at which a point at infinity blurs to `circle_mm`, m from the entrance pupil:
    /// f (2a/C + 1/m_p); everything from about half of it to infinity blurs less.
    pub(crate) fn hyperfocal_m(&self, focal_mm: f64, pupil_magnification: f64, circle_mm: f64) -> f64 {
        focal_mm * (2.0 * self.entrance_radius_mm / circle_mm + 1.0 / pupil_magnification) * MM
    }
}
