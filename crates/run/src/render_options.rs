//! How a compiled job is rendered.

use etendue_tracer::accel::Simd;
use std::ops::Range;

/// Frames that one run takes at most.
pub const MAX_FRAMES: usize = 100_000;

/// Which frames are taken, and how: what does not change the light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Frames to take, the last excluded; each has its own sensor noise. The light of a still world is rendered once.
    pub frames: Range<u32>,
    /// The instruction set of the accelerator. The result does not depend on it.
    pub simd: Simd,
}

impl Default for RenderOptions {
    /// Frame 0, by the best instruction set of the processor.
    fn default() -> Self {
        Self { frames: 0..1, simd: Simd::Auto }
    }
}
