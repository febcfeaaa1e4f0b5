//! A lens known by its ray-transfer functions alone.

use std::path::PathBuf;

use super::focus::{FocusDistance, focus_distance};
use super::numbers::share;
use crate::place::Placed;
use crate::reader::{keyed, number, path, record};

record! {
    /// A lens by its ray-transfer functions.
    pub struct RayTransfer {
        /// ISET's ray-transfer file.
        required file: Placed<PathBuf> = path(&["json"]);
        /// Where the sensor stands.
        inside sensor: SensorPlace;
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
    }
}

keyed! {
    /// Where the sensor stands.
    pub enum SensorPlace {
        /// Distance of what is sharpest on the axis from the entrance pupil, m, above 0, or "infinity".
        focus_distance_m => Focus(FocusDistance) = focus_distance();
        /// The sensor behind the last surface, mm, above 0 and beyond the input plane of the file (ISET's "filmdistance").
        sensor_distance_mm => Distance(Placed<f64>) = number("mm").above(0.0);
    }
}
