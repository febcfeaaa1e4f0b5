//! Lenses, pupil sampling and image-space lens operators: radiance in, irradiance on the sensor plane out.

pub mod defocus;
pub mod effects;
mod error;
pub mod front;
pub mod ghosts;
pub mod lens;
mod overlap;
pub mod prescription;
mod pupil;
pub mod pupil_image;
pub mod ray_transfer;

pub use defocus::{DepthOfField, FastBlend, FastParameters};
pub use effects::{Effects, EffectsError, EffectsParameters};
pub use error::OpticsError;
pub use front::{Front, FrontError, FrontRay};
pub use lens::{
    CalibratedLens, CalibratedParameters, ClippingAperture, ConstantPupil, Falloff, FalloffArgument, LateralColour,
    Lens, Pinhole, PinholeParameters, PrescriptionLens, PupilOrientation, PupilParameters, RayTransferLens,
    SensorPlace, Telecentric, TelecentricParameters, Thick, ThickParameters, Thin, ThinParameters, TruthRay,
};
pub use overlap::PRINCIPAL_NM;
pub use prescription::{Prescription, PrescriptionError, PrescriptionParameters};
pub use pupil_image::{BandEtendue, Cube, Face, PupilProjection, Resampling, View, Window, irradiance};
pub use ray_transfer::{RayTransfer, RayTransferError};
