//! What an effect may know beside its own parameters.

use crate::operation::Operation;
use crate::state::{FrameAddress, SensorState};
use etendue_core::random::{NoiseDraw, NoiseKey};

/// What all captures of a sensor have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorFacts {
    /// Whether randomness from frame to frame is modelled.
    pub(crate) noise: bool,
    /// The specimen's seed; `None`: that of the camera's place in the job.
    pub(crate) specimen: Option<u64>,
    /// Distance between the centres of neighbours, µm.
    pub(crate) pitch_um: f64,
    /// Columns and rows before the first pixel that light reaches.
    pub(crate) first_lit: [usize; 2],
    /// Time of collection, as described, s.
    pub(crate) exposure_s: f64,
    /// Time from frame to frame, s; `None` where it is not described.
    pub(crate) frame_period_s: Option<f64>,
    /// Exposures of a frame, one after the other: captures that do not read the charge of the one before.
    pub(crate) exposures: usize,
    /// Whether captures have photodiodes of their own.
    pub(crate) is_split_pixel: bool,
    /// The largest full well of all captures, e⁻.
    pub(crate) max_full_well_e: f64,
    /// Digital numbers an electron at an analogue gain of 1.
    pub(crate) gain_dn_e: f64,
    /// Factor on the voltage before the converter, as described.
    pub(crate) analogue_gain: f64,
    /// Digital numbers from black to the converter's largest.
    pub(crate) converter_range_dn: f64,
}

/// One capture: the sensor's facts, how it is taken, its random address, the size of the array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context {
    pub(crate) facts: SensorFacts,
    pub(crate) operation: Operation,
    pub(crate) address: FrameAddress,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// Seed of the patterns of cameras that are told apart by their place in the job alone.
const SPECIMENS: u64 = 0x7061_7474_6572_6e73;

impl Context {
    /// The key of a draw that differs from capture to capture.
    pub(crate) fn noise(&self, draw: NoiseDraw) -> NoiseKey {
        let FrameAddress { seed, camera, frame, capture } = self.address;
        NoiseKey::new(seed, camera, frame, capture, draw)
    }

    /// The key of a draw that differs from frame to frame, and is the same in all captures of a frame.
    pub(crate) fn frame_noise(&self, draw: NoiseDraw) -> NoiseKey {
        NoiseKey::new(self.address.seed, self.address.camera, self.address.frame, 0, draw)
    }

    /// The key of a draw of the specimen: the same in every frame and capture of every job.
    pub(crate) fn pattern(&self, draw: NoiseDraw) -> NoiseKey {
        match self.facts.specimen {
            Some(seed) => NoiseKey::new(seed, 0, 0, 0, draw),
            None => NoiseKey::new(SPECIMENS, self.address.camera, 0, 0, draw),
        }
    }
}

/// What a sensor remembers, as the last frame left it and as this frame leaves it.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    pub(crate) before: SensorState,
    pub(crate) after: SensorState,
}
