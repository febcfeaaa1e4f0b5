//! `[lens]`: from the scene to the sensor plane.

pub mod calibrated;
mod distortion;
mod focus;
mod lateral_colour;
mod numbers;
mod pinhole;
pub mod prescription;
pub mod projection;
pub mod ray_transfer;
mod telecentric;
mod thick;
mod thin;

use crate::reader::variants;

pub use calibrated::CalibratedLens;
pub use distortion::{Direction, Distortion, RadiusUnit};
pub use focus::{FocusDistance, InfinityWord};
pub use lateral_colour::LateralColour;
pub use pinhole::Pinhole;
pub use prescription::Prescription;
pub use ray_transfer::RayTransfer;
pub use telecentric::Telecentric;
pub use thick::{ClearAperture, Pupil, Thick};
pub use thin::Thin;

variants! {
    /// A lens.
    pub enum Lens by "type" {
        /// A pupil so small that everything is sharp; "f_number" sets the irradiance.
        "pinhole" => Pinhole(Pinhole),
        /// An ideal lens without thickness.
        "thin" => Thin(Thin),
        /// A paraxial lens with two principal planes, two pupils and two apertures that vignette.
        "thick" => Thick(Box<Thick>),
        /// A ray-traced lens of surfaces and glasses.
        "prescription" => Prescription(Box<Prescription>),
        /// A lens given by its ray-transfer functions.
        "ray_transfer" => RayTransfer(RayTransfer),
        /// A calibrated or ideal projection.
        "calibrated" => Calibrated(Box<CalibratedLens>),
        /// Object-side telecentric rays; everything is sharp.
        "telecentric" => Telecentric(Telecentric),
    }
}
