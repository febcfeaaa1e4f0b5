//! Operations of models on their image plane: distortion, the tilt of the sensor, an affine map.

mod distortion;
mod maps;
mod radial;

pub use distortion::{Distortion, DistortionTerms};
pub use maps::{Affine, Tilt};
