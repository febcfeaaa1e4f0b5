//! `[sensor]`: from the sensor plane to digital numbers.

pub mod cfa;
pub mod charge;
pub mod efficiency;
mod electronics;
pub mod exposure;
pub mod hdr;
pub mod read_out;
mod scale;
pub mod shutter;

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{number, record, vector, whole};

pub use efficiency::QuantumEfficiency;
pub use electronics::Electronics;
pub use scale::Scale;
pub use shutter::Shutter;

record! {
    /// A sensor: its geometry, and optionally its electronics.
    pub struct Sensor check(check) {
        /// Width of the image, px, 1 … 65 536.
        required width_px: Placed<u64> = whole(1, 65_536);
        /// Height of the image, px, 1 … 65 536.
        required height_px: Placed<u64> = whole(1, 65_536);
        /// Distance between pixel centres, µm, above 0; pixels are square.
        required pixel_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// Size of the image over that of the described sensor, "1/k" or the same as a decimal fraction: the same field of view with larger pixels,
        /// each in place of k × k. All other keys describe the full sensor; docs/sensor.md states how each of them scales. `--scale` sets it for all
        /// cameras. Default: 1.
        optional scale: Placed<Scale> = scale::ScaleRule;
        /// Fraction of a pixel's area that is sensitive (a centred square), above 0 and at most 1. Default: 1.
        optional fill_factor: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Intersection of the optical axis with the image, raster coordinates (the top-left corner is 0, 0), px. Default: the middle.
        optional principal_point_px: Placed<[f64; 2]> = vector::<2>(number("px"));
        /// Timing of the rows' exposure. Default: all rows together.
        optional shutter: Shutter = record();
        /// The electronics.
        group electronics: Electronics;
    }
}

fn check(sensor: &Sensor, faults: &mut Faults) {
    if let Some(electronics) = &sensor.electronics {
        if let Some(exposure) = sensor.shutter.as_ref().and_then(Shutter::exposure_s) {
            let problem = "\"exposure_s\" of the shutter contradicts that of the sensor's electronics";
            faults.add(
                ErrorCode::Contradiction,
                &exposure.place,
                problem,
                "remove it here: the sensor's \"exposure_s\" is the exposure time",
            );
        }
        electronics::check(electronics, faults);
    }
}
