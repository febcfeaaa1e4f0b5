//! Dirt on the front glass.

use std::path::PathBuf;

use crate::place::Placed;
use crate::reader::{number, path, record, vector};

record! {
    /// Dirt and scratches on the front glass: rays are weighted by an image of transmittance where they cross it.
    pub struct Dirt {
        /// Transmittance image seen from the camera: linear, 0 opaque, 1 clear, mean of its channels.
        required mask: Placed<PathBuf> = path(&["png", "exr"]);
        /// Width and height of the image on the glass, which is clean outside.
        required size_mm: Placed<[f64; 2]> = vector::<2>(number("mm").above(0.0));
        /// Distance from the entrance pupil to its middle along the axis; not beyond a windscreen.
        required distance_mm: Placed<f64> = number("mm").above(0.0);
        /// Offset of its middle from the axis, right and down. Default: 0.
        optional offset_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// Angle between its normal and the axis; positive tilts its top towards the camera. Default: 0.
        optional tilt_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
    }
}
