//! Captures of a frame: their light, how each is taken, and what a sensor remembers from frame to frame.

use etendue_core::{Plane, quantity::MeanElectrons};
use serde::{Deserialize, Serialize};

pub use etendue_core::random::FrameAddress;

/// The figures of one capture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Operation {
    /// Time of collection, s.
    pub(crate) exposure_s: f64,
    /// Factor on the mean electrons, which are those of the described exposure.
    pub(crate) light: f64,
    /// Electrons that a pixel can hold.
    pub(crate) full_well_e: f64,
    /// Digital numbers an electron, analogue gain included.
    pub(crate) gain_dn_e: f64,
    /// Standard deviation of a pixel's read noise, e⁻.
    pub(crate) read_noise_e: f64,
}

/// Mean electrons of a frame's captures, each as the first capture's exposure would gather them of the light that the capture
/// sees.
#[derive(Clone, Copy, Debug)]
pub struct CaptureLight<'a> {
    /// Of the first capture.
    pub first: &'a Plane<MeanElectrons>,
    /// Of the captures after it, one each; empty where all see the same light.
    pub further: &'a [Plane<MeanElectrons>],
}

impl<'a> CaptureLight<'a> {
    /// The same light in all captures.
    #[must_use]
    pub fn steady(means: &'a Plane<MeanElectrons>) -> Self {
        Self { first: means, further: &[] }
    }

    /// That of capture `k`, from 0.
    pub(crate) fn of(&self, k: usize) -> &'a Plane<MeanElectrons> {
        k.checked_sub(1).and_then(|i| self.further.get(i)).unwrap_or(self.first)
    }
}

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
