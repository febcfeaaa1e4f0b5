//! The thick lens: two principal planes, two pupils, two clear apertures.

use super::distortion::Distortion;
use super::focus::{FocusDistance, focus_distance};
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, focal_length, share};
use crate::place::Placed;
use crate::reader::{choice, number, record, words};

record! {
    /// A thick lens. Positions are along the axis towards the sensor, from the front principal plane.
    pub struct Thick {
        /// Focal length, mm, above 0.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length divided by the diameter of the entrance pupil, 0.5 or more.
        required f_number: Placed<f64> = f_number();
        /// Distance from the entrance pupil to the plane in focus, m, beyond the focal length, or "infinity".
        required focus_distance_m: FocusDistance = focus_distance();
        /// Transmittance of the lens, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Distortion. Default: none.
        optional distortion: Distortion = record();
        /// Lateral colour: image size by wavelength. Default: equal for all wavelengths.
        optional lateral_colour: LateralColour = record();
        /// Position of the rear principal plane, from the front principal plane, mm; may be negative. Default: 0.
        optional principal_separation_mm: Placed<f64> = number("mm");
        /// Position of the entrance pupil, from the front principal plane, mm; negative is towards the scene. One statement about the pupils fixes
        /// the others; several must agree. Default: the pupils lie in the principal planes.
        optional entrance_pupil_mm: Placed<f64> = number("mm");
        /// Position of the exit pupil, from the front principal plane, mm. See "entrance_pupil_mm".
        optional exit_pupil_mm: Placed<f64> = number("mm");
        /// Diameter of the exit pupil over that of the entrance pupil, above 0. See "entrance_pupil_mm".
        optional pupil_magnification: Placed<f64> = number("").above(0.0);
        /// Pupil whose area is constant over the field.
        required constant_pupil: Placed<Pupil> = choice();
        /// Clear aperture in front of the pupil. Default: none.
        optional front_aperture: Rim = record();
        /// Clear aperture behind the pupil. Default: none.
        optional rear_aperture: Rim = record();
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
    pub struct Rim {
        /// Position along the axis, from the front principal plane, mm.
        required position_mm: Placed<f64> = number("mm");
        /// Radius, mm, above 0.
        required radius_mm: Placed<f64> = number("mm").above(0.0);
    }
}
