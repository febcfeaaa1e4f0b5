//! Lenses without thickness: a pinhole, a thin lens, a parallel camera.
//!
//! A pinhole: every point of the scene is sharp, and a nominal f-number sets the irradiance.
//!
//! Irradiance in the small-pupil limit: E = τ π L cos⁴ θ′ / (4N²), with θ′ the angle at which the pinhole is seen from the sensor point itself (after
//! distortion). All light passes through one point, so the pupil sample changes nothing. The distance from sensor to pinhole is the focal length.
//! Left out: diffraction, which would blur the image of a real pinhole of this f-number, and the geometric blur of a large one.
//!
//! A thin lens: refraction in one plane, perfect imaging of the plane in focus, a finite pupil.
//!
//! The lens is a flat disc of diameter f/N and is both pupils. The sensor is at the image distance of the lens equation, c = f F/(F − f) for a focus
//! distance F, so close focus loses light (the bellows factor) by geometry alone. The weight is the exact τ ∫ cos θ cos θ′ / d² dA over the disc,
//! sampled uniformly by area; its mean is Foote's form factor. On the axis at infinity focus E = π τ L / (1 + 4N²): the **flat-disc convention** tan
//! θ′ = 1/2N (a lens that obeys the sine condition would give π τ L / 4N²).
//!
//! All rays of a sensor point meet in the point of the plane in focus that its chief ray meets. With a distortion the chief ray is the ideal point's,
//! and the disc is seen from the sensor point itself. Left out: aberrations, dispersion, diffraction, and a clipping mount.
//!
//! A parallel (orthographic) camera: every pixel looks along the axis, from its own position.
//!
//! The ideal of an object-side telecentric lens, with everything sharp: all its pencils have the same working f-number N on the sensor's side, so E =
//! π τ L/(4 N²) over the whole image (small-pupil limit). Sizes do not depend on distance: lengths in the scene and in the image have a constant
//! ratio, the width of the field over that of the image. The camera's position is the centre of a plane perpendicular to the axis from which the rays
//! begin; it sees nothing behind that plane.

use core::f64::consts::PI;

use etendue_core::ray::PupilRay;
use glam::{DVec2, DVec3};

use super::paraxial_properties::{Conjugates, ParaxialProperties, PupilSize};
use crate::error::OpticsError;
use crate::overlap::{PRINCIPAL_NM, f_number, positive};
use crate::pupil::{Pencil, PupilView, concentric_disc};

/// Parameters of a pinhole.
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
    /// The nominal pupil, used in the small-pupil limit only.
    pupil: PupilView,
}

impl Pinhole {
    /// Creates a pinhole.
    ///
    /// # Errors
    /// If a parameter is outside its range.
    pub fn new(parameters: PinholeParameters) -> Result<Self, OpticsError> {
        let distance_mm = positive("focal_length_mm", parameters.focal_length_mm)?;
        let radius_mm = distance_mm / (2.0 * f_number(parameters.f_number)?);
        let properties = ParaxialProperties::new(parameters.transmittance)?;
        Ok(Self { properties, parameters, pupil: PupilView { distance_mm, radius_mm } })
    }

    /// Construction parameters.
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

/// Parameters of a thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinParameters {
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
    /// Creates a thin lens.
    ///
    /// # Errors
    /// If a parameter is outside its range or the focus distance not beyond the focal length.
    pub fn new(parameters: ThinParameters) -> Result<Self, OpticsError> {
        let size = PupilSize::new(parameters.focal_length_mm, parameters.f_number)?;
        let conjugates = Conjugates::new(parameters.focal_length_mm, 1.0, parameters.focus_distance_m)?;
        Ok(Self { properties: ParaxialProperties::new(parameters.transmittance)?, parameters, conjugates, size })
    }

    /// Construction parameters.
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

/// Parameters of a telecentric camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelecentricParameters {
    /// Length in the scene per millimetre of the sensor, m.
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
    /// Creates a telecentric camera.
    ///
    /// # Errors
    /// If a parameter is outside its range.
    pub fn new(parameters: TelecentricParameters) -> Result<Self, OpticsError> {
        positive("field_width_m", parameters.metres_per_mm)?;
        let n = f_number(parameters.f_number)?;
        let transmittance = ParaxialProperties::new(parameters.transmittance)?.transmittance;
        Ok(Self { parameters, weight_sr: transmittance * PI / (4.0 * n * n) })
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &TelecentricParameters {
        &self.parameters
    }

    pub(super) fn principal_ray(&self, sensor_mm: DVec2) -> PupilRay {
        let origin_m = (sensor_mm * self.parameters.metres_per_mm).extend(0.0);
        PupilRay { origin_m, direction: DVec3::Z, weight_sr: self.weight_sr }
    }
}
