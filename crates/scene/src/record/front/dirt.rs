//! Dirt on the front glass.

use std::path::PathBuf;

use crate::place::Placed;
use crate::reader::{number, path, record, vector};

record! {
    /// Dirt and scratches on the front glass: rays are weighted by an image of transmittance where they cross it.
    pub struct Dirt {
        /// Image of transmittance: linear values, 0 opaque, 1 clear; of a coloured image the mean of its channels. The first row is the upper edge as
        /// seen from the camera, the first column the left one.
        required mask: Placed<PathBuf> = path(&["png", "exr"]);
        /// Width and height of the image on the glass, mm, above 0. The glass is clean outside it.
        required size_mm: Placed<[f64; 2]> = vector::<2>(number("mm").above(0.0));
        /// Distance from the centre of the entrance pupil to its middle, along the camera's axis, mm, above 0; not beyond a windscreen.
        required distance_mm: Placed<f64> = number("mm").above(0.0);
        /// Offset of its middle from the camera's axis, to the right and down, mm. Default: on the axis.
        optional offset_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// Angle between the normal of the glass and the camera's axis, degrees; positive tilts the upper edge towards the camera. −89 … 89. Default:
        /// 0.
        optional tilt_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
    }
}
