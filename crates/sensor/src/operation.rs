//! How one capture of a frame is taken: the figures that exposure control and captures change.

use crate::parameters::SensorParameters;
use crate::state::{FrameAddress, OperatingPoint};
use etendue_core::random::{NoiseDraw, NoiseKey};

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

impl Operation {
    /// The first capture of a frame at an operating point.
    pub(crate) fn base(p: &SensorParameters, point: OperatingPoint) -> Self {
        let described_s = p.exposure.exposure_s;
        let light = if point.exposure_s == described_s { 1.0 } else { point.exposure_s / described_s };
        Self {
            exposure_s: point.exposure_s,
            light,
            full_well_e: p.charge.full_well_e,
            gain_dn_e: p.read_out.gain_dn_e * point.analogue_gain,
            read_noise_e: p.read_out.noise.white_e,
        }
    }

    /// The first capture as described.
    pub(crate) fn described(p: &SensorParameters) -> Self {
        Self::base(p, OperatingPoint::described(p))
    }
}

/// What an effect may know when it is prepared: the sensor, the capture, its random address, the size of the array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context<'a> {
    pub(crate) p: &'a SensorParameters,
    pub(crate) operation: Operation,
    pub(crate) address: FrameAddress,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// Seed of the patterns of cameras that are told apart by their place in the job alone.
const SPECIMENS: u64 = 0x7061_7474_6572_6e73;

impl Context<'_> {
    /// The key of a draw that differs from capture to capture.
    pub(crate) fn noise(&self, draw: NoiseDraw) -> NoiseKey {
        let FrameAddress { seed, camera, frame, capture } = self.address;
        NoiseKey::new(seed, camera, frame, capture, draw)
    }

    /// The key of a draw of the specimen: the same in every frame and capture of every job.
    pub(crate) fn pattern(&self, draw: NoiseDraw) -> NoiseKey {
        pattern_key(self.p, self.address.camera, draw)
    }
}

/// The key of a draw of the specimen.
pub(crate) fn pattern_key(p: &SensorParameters, camera: u32, draw: NoiseDraw) -> NoiseKey {
    match p.pattern.seed {
        Some(seed) => NoiseKey::new(seed, 0, 0, 0, draw),
        None => NoiseKey::new(SPECIMENS, camera, 0, 0, draw),
    }
}
