//! The parallel (orthographic) camera.

use super::numbers::{f_number, fraction};
use crate::place::Placed;
use crate::reader::{number, record};

record! {
    /// A parallel (orthographic) camera.
    pub struct Telecentric {
        /// Width of the field of view in the scene.
        required field_width_m: Placed<f64> = number("m").above(0.0);
        /// f-number on the sensor's side; sets the irradiance.
        required f_number: Placed<f64> = f_number();
        /// Transmittance. Default: 1.
        optional transmittance: Placed<f64> = fraction();
    }
}
