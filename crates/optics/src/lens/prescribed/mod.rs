//! A prescription as a camera lens: rays from the sensor, traced out through every surface.
//!
//! Irradiance at a sensor point is E = ∫ L τ cos θ dω over the directions that pass, with τ from coatings and filter; in slopes t against the axis,
//! cos θ dω = cos⁴ θ dt. Samples are drawn from a region of slopes that contains everything that passes (Kolb, Mitchell and Hanrahan 1995; Steinert
//! et al. 2011) and weighted by the inverse of their density, so vignetting follows from the clear apertures without bias. A blocked sample carries
//! no light.
//!
//! - Rays begin where they leave the first surface. Principal rays start at their point nearest to the centre of the paraxial entrance pupil, the
//!   origin of the camera frame: real pupils of wide lenses move and tilt with the field.
//! - f-number (geometric, also of an obscured pupil): focal length over the diameter of the paraxial entrance pupil. On the axis light follows the real bundle; a lens corrected for coma
//!   gives E = π τ L/4N², not the flat disc's π τ L/(1 + 4N²).
//! - Neither pupil is constant: each field point has the pupil that its rays pass.
//! - [`PrescriptionLens::projected_solid_angle_sr`] holds at 587.56 nm, by a quadrature accurate to about 1e-5.

mod beam;
mod bundles;
mod chief;
mod light;
mod opening;
mod quadrature;
mod region;
mod report;
mod spot;

use glam::{DVec2, DVec3};

use crate::overlap::{PRINCIPAL_NM, positive};
use crate::prescription::coating::{Coating, InterferenceFilter};
use crate::prescription::{Prescription, PrescriptionError, Surface};
use crate::{error::OpticsError, lens::FieldAngles, lens::paraxial_properties::Conjugates, pupil::MM};
use chief::ChiefRays;
use region::Regions;

pub use report::{FieldReport, ImageReport, LateralShift, LensReport};
pub use spot::{OtherBundle, Spot};

pub(crate) use light::DIRECTIONS;

/// A focused prescription with its pupils determined for an image of a given size.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescriptionLens {
    prescription: Prescription,
    filter: Option<InterferenceFilter>,
    chiefs: ChiefRays,
    regions: Regions,
}

impl PrescriptionLens {
    /// Creates a lens for images that reach `picture_radius_mm` from the axis (farther out it is dark), with an optional filter in front of the
    /// sensor.
    ///
    /// # Errors
    /// If no light reaches the centre of the sensor or the radius is not positive.
    pub fn new(
        prescription: Prescription,
        filter: Option<InterferenceFilter>,
        picture_radius_mm: f64,
    ) -> Result<Self, OpticsError> {
        let picture_mm = positive("picture_radius_mm", picture_radius_mm)?;
        let chiefs = ChiefRays::new(&prescription, picture_mm);
        let regions = Regions::new(&prescription, picture_mm, |s_mm| chiefs.slope(&prescription, s_mm))
            .ok_or(PrescriptionError::Dark { nm: PRINCIPAL_NM })?;
        Ok(Self { prescription, filter, chiefs, regions })
    }

    /// The underlying prescription.
    #[must_use]
    pub fn prescription(&self) -> &Prescription {
        &self.prescription
    }

    /// True if a ray or its weight depends on the wavelength: by a glass, a coating or the filter.
    #[must_use]
    pub fn disperses(&self) -> bool {
        let layered = |s: &Surface| matches!(s.coating, Coating::QuarterWave { .. });
        self.filter.is_some() || self.prescription.disperses() || self.prescription.surfaces().iter().any(layered)
    }

    /// The radius within which light arrives, mm: the image's radius, or less if the lens becomes dark before.
    #[must_use]
    pub fn lit_radius_mm(&self) -> f64 {
        self.regions.limit_mm
    }

    /// Transmittance on the axis at 587.56 nm: coatings and filter.
    #[must_use]
    pub fn transmittance(&self) -> f64 {
        self.prescription.axial_transmittance(PRINCIPAL_NM) * self.filtered(PRINCIPAL_NM, 1.0)
    }

    /// First-order focusing, in the terms of the paraxial lenses.
    pub(super) fn conjugates(&self) -> Conjugates {
        let lens = &self.prescription;
        Conjugates {
            magnification: lens.magnification(),
            principal_distance_mm: lens.principal_distance_mm(),
            inverse_focus_per_mm: MM / lens.focus_distance_m(),
        }
    }

    /// Radius of the obscured part of the bundle on the axis over that of the bundle; 0 without an obscuration.
    #[must_use]
    pub fn obscured_ratio(&self) -> f64 {
        self.prescription.axial_obscured_ratio()
    }

    /// The angle from the axis seen by a height on the sensor, rad; `None` if it has no principal ray.
    pub(crate) fn field_angle(&self, height_mm: f64) -> Option<f64> {
        self.chiefs.ray(&self.prescription, height_mm).map(|ray| chief::field_angle(ray.direction))
    }

    /// Transmittance of the filter; 1 for none.
    pub(crate) fn filtered(&self, nm: f64, cosine: f64) -> f64 {
        self.filter.as_ref().map_or(1.0, |filter| filter.transmittance(nm, cosine))
    }

    /// Field angles of chief rays (through the centre of the stop) of a wavelength at `knots` radii up to `reach_mm`, or as far as they exist.
    pub(crate) fn field_angles(&self, reach_mm: f64, nm: f64, knots: usize) -> FieldAngles {
        ChiefRays::traced(&self.prescription, reach_mm, nm, knots).into_field_angles()
    }

    /// The sensor point of a direction of the camera frame, mm.
    pub(super) fn project(&self, direction: DVec3) -> Option<DVec2> {
        let across = direction.truncate();
        let angle = etendue_core::maths::f64::atan2(across.length(), direction.z);
        Some(across.normalize_or_zero() * self.chiefs.height_mm(&self.prescription, angle)?)
    }

    /// The principal ray's direction in the camera frame, clipped or not.
    pub(super) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        let ray = self.chiefs.ray(&self.prescription, sensor_mm.length())?;
        // In the upright image the scene lies on the point's own side.
        let across = sensor_mm.normalize_or_zero() * (-self.prescription.inversion() * ray.direction.x);
        Some(across.extend(-ray.direction.z))
    }
}
