//! A lens given only by its ray-transfer functions.

use std::path::PathBuf;

use super::focus::{FocusDistance, focus_distance};
use super::numbers::fraction;
use crate::place::Placed;
use crate::reader::{keyed, number, path, record};

record! {
    /// A lens given by its ray-transfer functions.
    pub struct RayTransfer {
        /// ISET's ray-transfer file.
        required file: Placed<PathBuf> = path(&["json"]);
        /// Position of the sensor.
        inside sensor: SensorPlace;
        /// Transmittance. Default: 1.
        optional transmittance: Placed<f64> = fraction();
    }
}

keyed! {
    /// Position of the sensor.
    pub enum SensorPlace {
        /// Distance from the entrance pupil to the point in best focus on the axis.
        focus_distance_m => Focus(FocusDistance) = focus_distance();
        /// Distance from the last surface to the sensor (ISET's "filmdistance"), beyond the file's input plane.
        sensor_distance_mm => Distance(Placed<f64>) = number("mm").above(0.0);
    }
}
