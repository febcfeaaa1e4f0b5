//! A lens given only by its ray-transfer functions.

use std::path::PathBuf;

use super::focus::{FocusDistance, focus_distance};
use super::numbers::share;
use crate::place::Placed;
use crate::reader::{keyed, number, path, record};

record! {
    /// A lens given by its ray-transfer functions.
    pub struct RayTransfer {
        /// ISET's ray-transfer file.
        required file: Placed<PathBuf> = path(&["json"]);
        /// Position of the sensor.
        inside sensor: SensorPlace;
        /// Transmittance of the lens, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
    }
}

keyed! {
    /// Position of the sensor.
    pub enum SensorPlace {
        /// Distance from the entrance pupil of the point in best focus on the axis, m, above 0, or "infinity".
        focus_distance_m => Focus(FocusDistance) = focus_distance();
        /// Distance from the last surface to the sensor, mm, above 0 and beyond the input plane of the file (ISET's "filmdistance").
        sensor_distance_mm => Distance(Placed<f64>) = number("mm").above(0.0);
    }
}
