//! Captures of a frame: their light, their operation, and the state of a sensor from frame to frame.

use etendue_core::{Plane, quantity::MeanElectrons};
use serde::{Deserialize, Serialize};

pub use etendue_core::random::FrameAddress;

/// The parameters of one capture's operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Operation {
    /// Exposure time, s.
    pub(crate) exposure_s: f64,
    /// Factor on the mean electrons, which are those of the described exposure.
    pub(crate) light: f64,
    /// Electrons that a pixel can hold.
    pub(crate) full_well_e: f64,
    /// Digital numbers per electron, analogue gain included.
    pub(crate) gain_dn_e: f64,
    /// Standard deviation of a pixel's read noise, e⁻.
    pub(crate) read_noise_e: f64,
}

/// Mean electrons of a frame's captures, each for the first capture's exposure to the light that the capture sees.
#[derive(Clone, Copy, Debug)]
pub struct CaptureLight<'a> {
    /// Of the first capture.
    pub first: &'a Plane<MeanElectrons>,
    /// Of the captures after it, one each; empty if all see the same light.
    pub further: &'a [Plane<MeanElectrons>],
}

impl<'a> CaptureLight<'a> {
    /// The same light in all captures.
    #[must_use]
    pub fn steady(means: &'a Plane<MeanElectrons>) -> Self {
        Self { first: means, further: &[] }
    }

    /// The light of capture `k`, from 0.
    pub(crate) fn capture(&self, k: usize) -> &'a Plane<MeanElectrons> {
        k.checked_sub(1).and_then(|i| self.further.get(i)).unwrap_or(self.first)
    }
}

/// Exposure time and gain of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OperatingPoint {
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Factor on the voltage before the ADC.
    pub analogue_gain: f64,
}

/// State of a sensor from frame to frame. The default is a sensor after a rest in the dark; the same holds, for each part, for a state of another
/// sensor size. Traps keep their charge over a frame without lag; every other part is set by the frame's own effects, or to the default if the frame
/// does not have them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorState {
    /// Current operating point of exposure control.
    pub operating_point: Option<OperatingPoint>,
    /// Charge in the traps, e⁻: for each kind of trap one value per pixel, row by row.
    pub trapped_e: Vec<Vec<f32>>,
    /// Levels of the blinking pixels (true: upper), in raster order.
    pub dark_current_rts_high: Vec<bool>,
    /// Levels of the pixels with RTS noise (true: upper), in raster order.
    pub rts_noise_high: Vec<bool>,
}
