//! Random numbers by address, not by sequence.
//!
//! Every random number of a simulation is a pure function of an address (seed, camera, frame, capture, pixel, replicate, sample, draw, sub-counter), so frames,
//! tiles and shards can be computed anywhere in any order.
//!
//! - [`PathStream`] serves light transport: scrambled Sobol points, stratified over the samples of a replicate.
//! - [`ShiftedLattice`] distributes the wavelengths of a pixel's samples evenly.
//! - [`GoldenSequence`] does so for an unknown number of samples.
//! - [`NoiseStream`] serves the sensor: independent words from a counter-based generator.
//! - [`number_of_name`] serves properties of a scene: a number from a name alone.
//! - [`stream_of_name`] serves the variations of the samples of a data set.

mod address;
mod noise;
mod path;
mod sequences;

pub use address::{Draw, FrameAddress, Pixel, PixelAddress, philox4x32};
pub use noise::{NoiseDraw, NoiseKey, NoiseStream, number_of_name, stream_of_name};
pub use path::PathStream;
pub use sequences::{GoldenSequence, ShiftedLattice};

/// Returns a float in [0, 1) from the upper 24 bits of a word.
#[inline]
#[must_use]
pub fn unit_f32(word: u32) -> f32 {
    (word >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Returns a float in [0, 1) from 53 bits of a double word.
#[inline]
#[must_use]
pub fn unit_f64(word: u64) -> f64 {
    (word >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}
