//! One frame: what all sensors of the table are given, and what they do.

use super::sensors;
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_sensor::{FrameAddress, Raw, Sensor, SensorState};

pub(super) const WIDTH: usize = 1920;

pub(super) const HEIGHT: usize = 1080;

pub(super) const PIXELS: f64 = (WIDTH * HEIGHT) as f64;

/// A ramp from none to the full well, with a lamp in it.
pub(super) fn scene() -> Plane<MeanElectrons> {
    let mean = |i: usize| {
        let (x, y) = (i % WIDTH, i / WIDTH);
        let in_lamp = (x.abs_diff(1300).pow(2) + y.abs_diff(500).pow(2)) < 24 * 24;
        if in_lamp {
            100.0 * sensors::FULL_WELL_E as f32
        } else {
            (sensors::FULL_WELL_E * x as f64 / WIDTH as f64) as f32
        }
    };
    Plane::from_samples(WIDTH, HEIGHT, (0..WIDTH * HEIGHT).map(mean).collect()).expect("one mean a pixel")
}

pub(super) fn expose(sensor: &Sensor, means: &Plane<MeanElectrons>) -> (SensorState, Raw) {
    sensor.step(SensorState::default(), means, FrameAddress { seed: 1, camera: 0, frame: 0, capture: 0 })
}
