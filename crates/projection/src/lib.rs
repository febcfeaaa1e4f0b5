//! Camera models as pure maths: projections, radial distortion, their inverses and conventions.
//!
//! | model | maps | file |
//! | --- | --- | --- |
//! | [`Rectilinear`] | direction ↔ ideal point of the sensor plane, mm | `rectilinear.rs` |
//! | [`RadialDistortion`] | ideal point ↔ observed point of the sensor plane, mm | `radial.rs` |
//! | [`Calibration`] | direction ↔ raster coordinates, px: a model with its camera matrix | `calibration.rs` |
//! | [`Model`] | direction ↔ point of the normalised image plane: the family of calibrated cameras | `model/`, on `plane/` |
//! | [`Raster`], [`CameraMatrix`] | point of the sensor plane, mm ↔ raster coordinates, px | `raster.rs` |
//!
//! Frames are those of `etendue_core`: camera x right, y down, z forward; sensor x right, y down as the erect image is
//! seen, mm from the principal point; raster x right, y down, pixel centres at + 0.5.

mod calibration;
pub mod model;
pub mod plane;
mod radial;
mod raster;
mod rectilinear;
mod root;

pub use calibration::{Calibration, CalibrationError};
pub use model::Model;
pub use radial::{
    DistortionDirection, DistortionError, DistortionFit, RadialDistortion, RadialPolynomial, RadiusScales, RadiusUnit,
};
pub use raster::{CameraMatrix, Raster, RasterError};
pub use rectilinear::Rectilinear;
