//! Camera models as pure maths: projections, radial distortion, their inverses and conventions.
//!
//! | model | maps | file |
//! | --- | --- | --- |
//! | [`Rectilinear`] | direction ↔ ideal point of the sensor plane, mm | `rectilinear.rs` |
//! | [`RadialDistortion`] | ideal point ↔ observed point of the sensor plane, mm | `radial.rs`, on `polynomial.rs`; `fit.rs` |
//! | [`Calibration`] | direction ↔ raster coordinates, px: a model with its camera matrix | `calibration.rs` |
//! | [`Model`] | direction ↔ point of the normalised image plane: the family of calibrated cameras | `model/`, on `plane/` |
//! | [`Raster`], [`CameraMatrix`] | point of the sensor plane, mm ↔ raster coordinates, px | `raster.rs` |
//!
//! Frames are those of `etendue_core`: camera x right, y down, z forward; sensor x right, y down as the erect picture is
//! seen, mm from the principal point; raster x right, y down, pixel centres at + 0.5.

mod calibration;
mod fit;
pub mod model;
mod model_error;
pub mod plane;
mod polynomial;
mod radial;
mod raster;
mod rectilinear;
mod root;

pub use calibration::{Calibration, CalibrationError};
pub use fit::Fit;
pub use model::Model;
pub use polynomial::RadialPolynomial;
pub use radial::{DistortionError, RadialDistortion, RadiusScales, RadiusUnit, Sense};
pub use raster::{CameraMatrix, Raster, RasterError};
pub use rectilinear::Rectilinear;
