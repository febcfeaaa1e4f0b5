//! The thin lens.

use super::distortion::Distortion;
use super::focus::{FocusDistance, focus_distance};
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, focal_length, share};
use crate::place::Placed;
use crate::reader::record;

record! {
    /// A thin lens.
    pub struct Thin {
        /// Focal length, mm, above 0.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length divided by the diameter of the pupil, 0.5 or more.
        required f_number: Placed<f64> = f_number();
        /// Distance from the entrance pupil to the plane in focus, m, beyond the focal length, or "infinity".
        required focus_distance_m: FocusDistance = focus_distance();
        /// Transmittance of the lens, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Distortion. Default: none.
        optional distortion: Distortion = record();
        /// Lateral colour: image size by wavelength. Default: equal for all wavelengths.
        optional lateral_colour: LateralColour = record();
    }
}
