//! Lenses.
//!
//! # Contract
//!
//! - All arithmetic is f64. Rays are in the camera frame (x right, y down, z forward, m) whose origin is the centre of the
//!   **entrance pupil**. Sensor points are mm of the erect image from the principal point.
//! - [`Lens::ray`] generates a ray from a sensor point and a pupil sample; the mean over pupil samples of `weight_sr` × radiance is the irradiance of
//!   the sensor point. `None` means that the sample carries no light: it counts as zero.
//! - [`Lens::projected_solid_angle_sr`] is the mean of the weights, computed without samples: in closed form, or by a quadrature to 1e-9 (through a
//!   prescription, whose clear apertures have no closed form, at 587.56 nm and to 1e-5).
//! - [`Lens::principal_ray`] goes through the centre of the pupil (of the real stop) at 587.56 nm, and [`Lens::project`] is
//!   its inverse.
//! - A calibrated and a telecentric camera define their own (`calibrated.rs`, `telecentric.rs`).
//! - An optional radial distortion maps the observed sensor point to the ideal one before the ray is generated; the weight is that of the observed
//!   point, where the light arrives. A lateral colour ([`LateralColour`]) acts before it.
//! - f-number of the paraxial lenses: a flat pupil disc, tan θ′ = 1/2N at infinity focus, so E = π τ L / (1 + 4N²) on the axis. (The pinhole is the
//!   small-pupil limit: π τ L / 4N².)

/// Dispatches to the common code of the paraxial lenses, or to the other kinds.
macro_rules! each {
    ($self:expr, $lens:ident => $body:expr, $($other:ident($it:pat) => $does:expr),+ $(,)?) => {
        match $self {
            Lens::Pinhole($lens) => $body,
            Lens::Thin($lens) => $body,
            Lens::Thick($lens) => $body,
            $(Lens::$other($it) => $does,)+
        }
    };
}

mod calibrated;
mod directions;
mod field_angles;
mod first_order;
mod measures;
mod paraxial_properties;
mod prescribed;
mod rays;
mod search;
mod simple;
mod thick;
mod transferred;

use std::sync::Arc;

use etendue_projection::{RadialDistortion, Raster};

use crate::error::OpticsError;

pub use calibrated::{CalibratedLens, CalibratedParameters, PupilOrientation};
pub use paraxial_properties::{Falloff, FalloffArgument, LateralColour, PupilParameters};
pub use prescribed::{FieldReport, ImageReport, LateralShift, LensReport, OtherBundle, PrescriptionLens, Spot};
pub use rays::TruthRay;
pub use simple::{Pinhole, PinholeParameters, Telecentric, TelecentricParameters, Thin, ThinParameters};
pub use thick::{ClippingAperture, ConstantPupil, Thick, ThickParameters};
pub use transferred::{RayTransferLens, SensorPlace};

pub(crate) use field_angles::FieldAngles;
pub(crate) use prescribed::DIRECTIONS;

/// A lens: the closed list.
#[derive(Clone, Debug, PartialEq)]
pub enum Lens {
    /// Everything sharp, nominal brightness.
    Pinhole(Pinhole),
    /// One refracting plane, finite pupil.
    Thin(Thin),
    /// Principal planes, pupils and apertures.
    Thick(Thick),
    /// Surfaces, glasses, a stop: traced.
    Prescription(Arc<PrescriptionLens>),
    /// Ray-transfer functions: one step per ray.
    RayTransfer(Arc<RayTransferLens>),
    /// Viewing directions by a projection.
    Calibrated(Arc<CalibratedLens>),
    /// Every pixel looks along the axis.
    Telecentric(Telecentric),
}

impl Lens {
    /// Creates a pinhole.
    ///
    /// # Errors
    /// As [`Pinhole::new`].
    pub fn pinhole(parameters: PinholeParameters) -> Result<Self, OpticsError> {
        Pinhole::new(parameters).map(Self::Pinhole)
    }

    /// Creates a thin lens.
    ///
    /// # Errors
    /// As [`Thin::new`].
    pub fn thin(parameters: ThinParameters) -> Result<Self, OpticsError> {
        Thin::new(parameters).map(Self::Thin)
    }

    /// Creates a thick lens.
    ///
    /// # Errors
    /// As [`Thick::new`].
    pub fn thick(parameters: ThickParameters) -> Result<Self, OpticsError> {
        Thick::new(parameters).map(Self::Thick)
    }

    /// Creates a lens from a prescription.
    #[must_use]
    pub fn prescription(lens: PrescriptionLens) -> Self {
        Self::Prescription(Arc::new(lens))
    }

    /// Creates a lens from ray-transfer functions.
    #[must_use]
    pub fn ray_transfer(lens: RayTransferLens) -> Self {
        Self::RayTransfer(Arc::new(lens))
    }

    /// Creates a calibrated camera.
    ///
    /// # Errors
    /// As [`CalibratedLens::new`].
    pub fn calibrated(parameters: CalibratedParameters) -> Result<Self, OpticsError> {
        CalibratedLens::new(parameters).map(|lens| Self::Calibrated(Arc::new(lens)))
    }

    /// Creates a telecentric camera.
    ///
    /// # Errors
    /// As [`Telecentric::new`].
    pub fn telecentric(parameters: TelecentricParameters) -> Result<Self, OpticsError> {
        Telecentric::new(parameters).map(Self::Telecentric)
    }

    /// The same lens with a radial distortion. A distortion whose radius unit is the focal length is built with [`Lens::principal_distance_mm`] of
    /// the lens without it.
    ///
    /// # Errors
    /// For a prescription, a calibrated and a telecentric camera, which have their own.
    pub fn with_distortion(mut self, distortion: RadialDistortion) -> Result<Self, OpticsError> {
        each!(&mut self,
            lens => lens.properties.distortion = Some(distortion),
            Prescription(_) => return Err(OpticsError::OwnDistortion),
            RayTransfer(_) => return Err(OpticsError::OwnDistortion),
            Calibrated(_) => return Err(OpticsError::OwnDistortion),
            Telecentric(_) => return Err(OpticsError::OwnDistortion),
        );
        Ok(self)
    }

    /// The radial distortion added to the lens, if any.
    #[must_use]
    pub fn distortion(&self) -> Option<&RadialDistortion> {
        each!(self, lens => lens.properties.distortion.as_ref(), Prescription(_) => None, RayTransfer(_) => None, Calibrated(_) => None, Telecentric(_) => None)
    }

    /// The same lens with lateral colour.
    ///
    /// # Errors
    /// For a prescription, which has its own, and a telecentric camera, which has no principal point as a centre.
    pub fn with_lateral_colour(mut self, colour: LateralColour) -> Result<Self, OpticsError> {
        each!(&mut self,
            lens => lens.properties.lateral_colour = Some(Arc::new(colour)),
            Prescription(_) => return Err(OpticsError::OwnColour { kind: "prescription" }),
            RayTransfer(_) => return Err(OpticsError::OwnColour { kind: "ray-transfer lens" }),
            Calibrated(lens) => Arc::make_mut(lens).lateral_colour = Some(colour),
            Telecentric(_) => return Err(OpticsError::OwnColour { kind: "telecentric camera" }),
        );
        Ok(self)
    }

    /// The lateral colour added to the lens, if any.
    #[must_use]
    pub fn lateral_colour(&self) -> Option<&LateralColour> {
        each!(self,
            lens => lens.properties.lateral_colour.as_deref(),
            Prescription(_) => None,
            RayTransfer(_) => None,
            Calibrated(lens) => lens.lateral_colour.as_ref(),
            Telecentric(_) => None,
        )
    }

    /// Kind of the lens, in words.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Pinhole(_) => "pinhole",
            Self::Thin(_) => "thin lens",
            Self::Thick(_) => "thick lens",
            Self::Prescription(_) => "prescription",
            Self::RayTransfer(_) => "ray-transfer lens",
            Self::Calibrated(_) => "calibrated camera",
            Self::Telecentric(_) => "telecentric camera",
        }
    }

    /// Refuses an image that the lens cannot form.
    ///
    /// # Errors
    /// If the distortion folds inside the image or is not that of a lens, the image reaches beyond the lens's field, or its size is not that of the
    /// calibration.
    pub fn check(&self, raster: &Raster) -> Result<(), OpticsError> {
        if let Self::Calibrated(lens) = self {
            return lens.check(raster);
        }
        let (radius_mm, focal_mm) = (raster.max_radius_mm(), self.principal_distance_mm());
        match (self, self.distortion()) {
            (_, Some(distortion)) => {
                distortion.check(radius_mm)?;
                field_angles::check(radius_mm, focal_mm, &field_angles::ALL, |r| distortion.ideal_radius_mm(r))
            }
            (Self::Pinhole(_) | Self::Thin(_) | Self::Thick(_), None) => {
                field_angles::check(radius_mm, focal_mm, &[], Some)
            }
            _ => Ok(()),
        }
    }
}
