//! First-order quantities: focal length, f-number, transmittance, focus.

use etendue_projection::Rectilinear;

use super::Lens;

impl Lens {
    /// Focal length, mm; infinite for a telecentric camera.
    #[must_use]
    pub fn focal_length_mm(&self) -> f64 {
        each!(self,
            lens => lens.parameters().focal_length_mm,
            Prescription(lens) => lens.prescription().paraxial().focal_length_mm.abs(),
            RayTransfer(lens) => lens.focal_length_mm(),
            Calibrated(lens) => lens.focal_length_mm(),
            Telecentric(_) => f64::INFINITY,
        )
    }

    /// The wavelength of a dispersive lens's focal length, f-number and focus, nm; `None` if they do not depend on one.
    #[must_use]
    pub fn first_order_nm(&self) -> Option<f64> {
        match self {
            Self::Prescription(lens) => Some(lens.prescription().reference_nm()),
            Self::RayTransfer(lens) => Some(lens.first_order_nm()),
            _ => None,
        }
    }

    /// f-number at infinity focus (of a telecentric camera: on the sensor's side).
    #[must_use]
    pub fn f_number(&self) -> f64 {
        each!(self,
            lens => lens.parameters().f_number,
            Prescription(lens) => lens.prescription().paraxial().f_number(),
            RayTransfer(lens) => lens.f_number(),
            Calibrated(lens) => lens.parameters().f_number,
            Telecentric(lens) => lens.parameters().f_number,
        )
    }

    /// Radius of the pupil's central obscuration on the axis over the pupil's; 0 for none. The f-number ignores it.
    #[must_use]
    pub fn obscured_ratio(&self) -> f64 {
        match self {
            Self::Prescription(lens) => lens.obscured_ratio(),
            _ => 0.0,
        }
    }

    /// Open fraction of the pupil's area on the axis: 1 without a central obscuration.
    #[must_use]
    pub fn open_fraction(&self) -> f64 {
        1.0 - self.obscured_ratio() * self.obscured_ratio()
    }

    /// Transmittance τ.
    #[must_use]
    pub fn transmittance(&self) -> f64 {
        each!(self,
            lens => lens.parameters().transmittance,
            Prescription(lens) => lens.transmittance(),
            RayTransfer(lens) => lens.transmittance(),
            Calibrated(lens) => lens.parameters().transmittance,
            Telecentric(lens) => lens.parameters().transmittance,
        )
    }

    /// T-number N/√(τ a), a the open fraction of the pupil.
    #[must_use]
    pub fn t_number(&self) -> f64 {
        self.f_number() / (self.transmittance() * self.open_fraction()).sqrt()
    }

    /// Distance of the plane in focus from the entrance pupil, m; `None` if everything is sharp.
    #[must_use]
    pub fn focus_distance_m(&self) -> Option<f64> {
        match self {
            Self::Pinhole(_) | Self::Telecentric(_) => None,
            Self::Calibrated(lens) => lens.parameters().focus_distance_m,
            Self::Thin(lens) => Some(lens.parameters().focus_distance_m),
            Self::Thick(lens) => Some(lens.parameters().focus_distance_m),
            Self::Prescription(lens) => Some(lens.prescription().focus_distance_m()),
            Self::RayTransfer(lens) => Some(lens.focus_distance_m()),
        }
    }

    /// The principal distance c, mm: near the axis a tangent t of object space is imaged at c·t on the sensor. Infinite for a telecentric camera.
    #[must_use]
    pub fn principal_distance_mm(&self) -> f64 {
        match self {
            Self::Pinhole(lens) => lens.principal_distance_mm(),
            Self::Thin(lens) => lens.conjugates.principal_distance_mm,
            Self::Thick(lens) => lens.conjugates.principal_distance_mm,
            Self::Prescription(lens) => lens.prescription().principal_distance_mm(),
            Self::RayTransfer(lens) => lens.conjugates().principal_distance_mm,
            Self::Calibrated(lens) => lens.focal_length_mm(),
            Self::Telecentric(_) => f64::INFINITY,
        }
    }

    /// The projection of the lens without its distortion.
    #[must_use]
    pub fn rectilinear(&self) -> Rectilinear {
        Rectilinear { principal_distance_mm: self.principal_distance_mm() }
    }
}
