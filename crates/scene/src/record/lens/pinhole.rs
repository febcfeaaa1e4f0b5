//! The pinhole camera.

use super::distortion::Distortion;
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, focal_length, share};
use crate::place::Placed;
use crate::reader::record;

record! {
    /// A pinhole.
    pub struct Pinhole {
        /// Distance of the pinhole from the sensor, mm, above 0.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length divided by the pinhole's diameter, 0.5 or more; it sets the irradiance.
        required f_number: Placed<f64> = f_number();
        /// Transmittance of the lens, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Distortion. Default: none.
        optional distortion: Distortion = record();
        /// Lateral colour: image size by wavelength. Default: equal for all wavelengths.
        optional lateral_colour: LateralColour = record();
    }
}
