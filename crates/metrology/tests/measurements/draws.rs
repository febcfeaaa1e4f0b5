//! Random numbers.

use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use rand_distr::{Distribution, StandardNormal};

/// Standard normal numbers, one series per seed and purpose.
pub(crate) fn normals(seed: u64, purpose: u32) -> impl FnMut() -> f64 {
    let mut stream = NoiseStream::new(seed, 0, purpose, 0, Pixel { x: 0, y: 0 }, NoiseDraw::Read);
    move || StandardNormal.sample(&mut stream)
}
