//! The thin lens.

use super::distortion::Distortion;
use super::focus::{FocusDistance, focus_distance};
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, focal_length, fraction};
use crate::place::Placed;
use crate::reader::record;

record! {
    /// A thin lens.
    pub struct Thin {
        /// Focal length.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length over the pupil's diameter.
        required f_number: Placed<f64> = f_number();
        /// Distance from the entrance pupil to the plane in focus, beyond the focal length.
        required focus_distance_m: FocusDistance = focus_distance();
        /// Transmittance. Default: 1.
        optional transmittance: Placed<f64> = fraction();
        /// Distortion.
        optional distortion: Distortion = record();
        /// Image size by wavelength. Default: equal.
        optional lateral_colour: LateralColour = record();
    }
}
