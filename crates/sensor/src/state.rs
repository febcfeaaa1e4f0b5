//! What a sensor remembers from frame to frame, and where a frame stands.

pub use etendue_core::random::FrameAddress;

use serde::{Deserialize, Serialize};

/// Exposure time and gain of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OperatingPoint {
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Factor on the voltage before the converter.
    pub analogue_gain: f64,
}

/// What a sensor remembers from frame to frame. The default is a sensor that has rested in the dark; so is, for each
/// part, a state of another size of sensor. Traps keep their charge over a frame that has no lag; every other part is what the frame's own
/// effects leave, and the default where the frame does not have them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorState {
    /// Where exposure control has come to.
    pub operating_point: Option<OperatingPoint>,
    /// Charge in the traps, e⁻: for each kind of trap one number a pixel, row by row.
    pub trapped_e: Vec<Vec<f32>>,
    /// Which blinking pixels are at their upper level, in raster order.
    pub dark_current_rts_high: Vec<bool>,
    /// Which pixels of RTS noise are at their upper level, in raster order.
    pub rts_noise_high: Vec<bool>,
}
