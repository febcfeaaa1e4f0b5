//! How a compiled job is rendered.

use clap::Args;
use etendue_arguments::frames;
use etendue_tracer::accel::Simd;
use std::ops::Range;

/// Which frames are taken, and how: what does not change the light.
#[derive(Args, Clone, Debug, Eq, PartialEq)]
pub struct RenderOptions {
    /// Frames to take, first to last (the last excluded); each has its own sensor noise. Light that does not depend on time is
    /// rendered once
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: Range<u32>,
    /// The instruction set of the accelerator. The result does not depend on it.
    #[arg(skip)]
    pub simd: Simd,
}

impl Default for RenderOptions {
    /// Frame 0, by the best instruction set of the processor.
    fn default() -> Self {
        Self { frames: 0..1, simd: Simd::Auto }
    }
}
