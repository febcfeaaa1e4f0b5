//! The camera: lens, effects, sensor, processing.

use super::effects::Effects;
use super::front::Front;
use super::lens::Lens;
use super::processing::Processing;
use super::sensor::Sensor;
use crate::fault::{ErrorCode, Faults};
use crate::reader::record;

record! {
    /// A camera, wherever it stands.
    pub struct Camera check(check) {
        /// The lens.
        required lens: Lens = record();
        /// What stands in front of the lens, attached to the camera. Default: nothing.
        optional external_optics: Front = record();
        /// What becomes of the irradiance behind the lens. Default: nothing.
        optional effects: Effects = record();
        /// The sensor.
        required sensor: Sensor = record();
        /// From raw to picture. Default: none, no picture is made.
        optional isp: Processing = record();
    }
}

fn check(camera: &Camera, faults: &mut Faults) {
    if let (Some(processing), None) = (&camera.isp, &camera.sensor.electronics) {
        faults.add(
            ErrorCode::NoEffect,
            &processing.place,
            "a sensor without electronics makes no raw to process",
            "add \"exposure_s\", \"cfa\", … to the sensor, or remove \"isp\"",
        );
    }
}
