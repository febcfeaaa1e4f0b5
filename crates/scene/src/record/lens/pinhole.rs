//! The pinhole camera.

use super::distortion::Distortion;
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, focal_length, fraction};
use crate::place::Placed;
use crate::reader::record;

record! {
    /// A pinhole.
    pub struct Pinhole {
        /// Distance from the pinhole to the sensor.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length over the pinhole's diameter; sets the irradiance.
        required f_number: Placed<f64> = f_number();
        /// Transmittance. Default: 1.
        optional transmittance: Placed<f64> = fraction();
        /// Distortion.
        optional distortion: Distortion = record();
        /// Image size by wavelength. Default: equal.
        optional lateral_colour: LateralColour = record();
    }
}
