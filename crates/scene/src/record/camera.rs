//! The camera: lens, effects, sensor, processing.

use super::effects::Effects;
use super::front::ExternalOptics;
use super::lens::Lens;
use super::processing::Processing;
use super::sensor::Sensor;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::reader::record;

record! {
    /// A camera, independent of its pose.
    pub struct Camera check(check) {
        /// The lens.
        required lens: Lens = record();
        /// Elements in front of the lens.
        optional external_optics: ExternalOptics = record();
        /// Effects on the irradiance.
        optional effects: Effects = record();
        /// The sensor.
        required sensor: Sensor = record();
        /// Processing from raw to image. Default: none, no image.
        optional isp: Processing = record();
    }
}

fn check(camera: &Camera, errors: &mut DescriptionErrors) {
    if let (Some(processing), None) = (&camera.isp, &camera.sensor.electronics) {
        errors.add(
            ErrorCode::NoEffect,
            &processing.place,
            "a sensor without electronics gives no raw to process",
            "add \"exposure_s\", \"cfa\", … to the sensor, or remove \"isp\"",
        );
    }
}
