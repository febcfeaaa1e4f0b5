//! The thick lens: two principal planes, two pupils, two clear apertures.

use super::distortion::Distortion;
use super::focus::{FocusDistance, focus_distance};
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, focal_length, fraction};
use crate::place::Placed;
use crate::reader::{choice, number, record, words};

record! {
    /// A thick lens. Positions are along the axis towards the sensor, from the front principal plane.
    pub struct Thick {
        /// Focal length.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length over the entrance pupil's diameter.
        required f_number: Placed<f64> = f_number();
        /// Distance from the entrance pupil to the plane in focus, beyond the focal length.
        required focus_distance_m: FocusDistance = focus_distance();
        /// Transmittance. Default: 1.
        optional transmittance: Placed<f64> = fraction();
        /// Distortion.
        optional distortion: Distortion = record();
        /// Image size by wavelength. Default: equal.
        optional lateral_colour: LateralColour = record();
        /// Position of the rear principal plane from the front one. Default: 0.
        optional principal_separation_mm: Placed<f64> = number("mm");
        /// Position of the entrance pupil from the front principal plane, negative towards the scene. The pupil keys must agree. Default: pupils in the
        /// principal planes.
        optional entrance_pupil_mm: Placed<f64> = number("mm");
        /// Position of the exit pupil from the front principal plane; see "entrance_pupil_mm".
        optional exit_pupil_mm: Placed<f64> = number("mm");
        /// Exit pupil's diameter over the entrance pupil's; see "entrance_pupil_mm".
        optional pupil_magnification: Placed<f64> = number("").above(0.0);
        /// Pupil whose area is constant over the field.
        required constant_pupil: Placed<Pupil> = choice();
        /// Aperture in front of the pupil.
        optional front_aperture: ClearAperture = record();
        /// Aperture behind the pupil.
        optional rear_aperture: ClearAperture = record();
    }
}

words! {
    /// One of the two pupils of a lens.
    pub enum Pupil {
        /// The pupil as seen from the scene.
        "entrance" => Entrance,
        /// The pupil as seen from the sensor.
        "exit" => Exit,
    }
}

record! {
    /// A round clear aperture.
    pub struct ClearAperture {
        /// Position from the front principal plane.
        required position_mm: Placed<f64> = number("mm");
        /// Radius.
        required radius_mm: Placed<f64> = number("mm").above(0.0);
    }
}
