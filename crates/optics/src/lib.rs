//! Lenses, pupil sampling and image-space lens operators: radiance in, irradiance on the sensor plane out.

mod error;
pub mod lens;
mod overlap;
mod pupil;
pub mod pupil_image;

pub use error::OpticsError;
pub use lens::{
    ConstantPupil, Lens, Pinhole, PinholeParameters, PupilStatements, Rim, Thick, ThickParameters, Thin,
    ThinParameters, TruthRay,
};
pub use pupil_image::{PupilProjection, Resampling, irradiance};
