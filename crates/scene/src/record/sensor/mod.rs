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

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{integer, number, record, vector};

pub use efficiency::QuantumEfficiency;
pub use electronics::Electronics;
pub use scale::Scale;
pub use shutter::Shutter;

record! {
    /// A sensor: its geometry, and optionally its electronics.
    pub struct Sensor check(check) {
        /// Image width.
        required width_px: Placed<u64> = integer(1, 65_536);
        /// Image height.
        required height_px: Placed<u64> = integer(1, 65_536);
        /// Pixel pitch; pixels are square.
        required pixel_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// Image size over the sensor's, with an equal field of view: each pixel replaces k × k. Default: 1.
        optional scale: Placed<Scale> = scale::ScaleRule;
        /// Sensitive fraction of a pixel, a centred square. Default: 1.
        optional fill_factor: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Optical axis in the image, raster coordinates. Default: the middle.
        optional principal_point_px: Placed<[f64; 2]> = vector::<2>(number("px"));
        /// Timing of the rows. Default: all together.
        optional shutter: Shutter = record();
        /// The electronics.
        group electronics: Electronics;
    }
}

fn check(sensor: &Sensor, errors: &mut DescriptionErrors) {
    if let Some(electronics) = &sensor.electronics {
        if let Some(exposure) = sensor.shutter.as_ref().and_then(Shutter::exposure_s) {
            let problem = "\"exposure_s\" of the shutter contradicts that of the sensor's electronics";
            errors.add(
                ErrorCode::Contradiction,
                &exposure.place,
                problem,
                "remove it here: the sensor's \"exposure_s\" is the exposure time",
            );
        }
        electronics::check(electronics, errors);
    }
}
