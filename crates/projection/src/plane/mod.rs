//! What a model does to points of its image plane: distortion, the tilt of the sensor, an affine map.

mod affine;
mod distortion;
mod radial;
mod tilt;

pub use affine::Affine;
pub use distortion::{Distortion, DistortionTerms};
pub use tilt::Tilt;
