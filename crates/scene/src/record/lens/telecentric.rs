//! The parallel (orthographic) camera.

use super::numbers::{f_number, share};
use crate::place::Placed;
use crate::reader::{number, record};

record! {
    /// A parallel (orthographic) camera.
    pub struct Telecentric {
        /// Width of what is seen, m, above 0: the picture's width in the scene.
        required field_width_m: Placed<f64> = number("m").above(0.0);
        /// f-number on the sensor's side, 0.5 or more: how much light comes through.
        required f_number: Placed<f64> = f_number();
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
    }
}
