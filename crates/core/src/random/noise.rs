//! Independent random words for sensor noise.

use core::convert::Infallible;

use rand_core::TryRng;

use super::address::{Pixel, mix, philox4x32};
use super::{unit_f32, unit_f64};

/// Purpose of a random number of a sensor. Append-only: the discriminants are part of the guaranteed bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum NoiseDraw {
    /// Photon shot noise.
    Shot = 0,
    /// Shot noise of the dark current.
    Dark = 1,
    /// Read noise.
    Read = 2,
    /// Read noise of a row, at column 0.
    RowRead = 3,
    /// Read noise of a column, at row 0.
    ColumnRead = 4,
    /// Level changes of a two-level (RTS) pixel.
    TelegraphFlip = 5,
    /// Level changes of a pixel's dark current (dark-current RTS).
    BlinkingFlip = 6,
    /// Fixed pattern: a pixel's response to light. Patterns are addressed without frame and capture.
    PixelResponse = 7,
    /// Fixed pattern: a row's response to light, at column 0.
    RowResponse = 8,
    /// Fixed pattern: a column's response to light, at row 0.
    ColumnResponse = 9,
    /// Fixed pattern: a pixel's dark current.
    PixelDark = 10,
    /// Fixed pattern: a row's dark current, at column 0.
    RowDark = 11,
    /// Fixed pattern: a column's dark current, at row 0.
    ColumnDark = 12,
    /// Fixed pattern: a pixel's offset.
    PixelOffset = 13,
    /// Fixed pattern: a row's offset, at column 0.
    RowOffset = 14,
    /// Fixed pattern: a column's offset, at row 0.
    ColumnOffset = 15,
    /// Fixed pattern: choice and strength of a row's hot pixels; at column 0.
    Hot = 16,
    /// Fixed pattern: choice of a row's dead pixels; at column 0.
    Dead = 17,
    /// Fixed pattern: choice and strength of a row's pixels with dark-current RTS; at column 0.
    Blinking = 18,
    /// Fixed pattern: choice and strength of a row's pixels with RTS noise; at column 0.
    Telegraph = 19,
    /// Trigger jitter of a frame's start; at pixel (0, 0).
    TriggerJitter = 20,
    /// Pulse noise on a finished image, as in the paper.
    PaperPulse = 64,
    /// Additive Gaussian noise on a finished image, as in the paper.
    PaperGaussian = 65,
    /// Multiplicative uniform noise on a finished image, as in the paper.
    PaperUniform = 66,
}

/// Key of one purpose for one (seed, camera, frame, capture); gives the streams of its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoiseKey([u32; 2]);

impl NoiseKey {
    /// Returns the key of a purpose.
    #[must_use]
    pub fn new(seed: u64, camera: u32, frame: u32, capture: u32, purpose: NoiseDraw) -> Self {
        let key = mix(mix(seed) ^ (u64::from(camera) | u64::from(frame) << 32));
        let key = mix(key ^ (u64::from(capture) | u64::from(purpose as u32) << 32));
        Self([key as u32, (key >> 32) as u32])
    }

    /// The stream of a pixel.
    #[inline]
    #[must_use]
    pub fn stream(self, pixel: Pixel) -> NoiseStream {
        NoiseStream { key: self.0, counter: [0, 0, pixel.x, pixel.y], words: [0; 4], used: 4 }
    }
}

/// Stream of independent words for one (seed, camera, frame, capture, pixel, draw): Philox4x32-10, the sub-counter running.
///
/// It implements rand's generator trait, so that `rand_distr` can serve as an oracle in tests.
#[derive(Clone, Debug)]
pub struct NoiseStream {
    key: [u32; 2],
    counter: [u32; 4],
    words: [u32; 4],
    used: usize,
}

impl NoiseStream {
    /// Returns the stream of one purpose for one pixel.
    #[must_use]
    pub fn new(seed: u64, camera: u32, frame: u32, capture: u32, pixel: Pixel, purpose: NoiseDraw) -> Self {
        NoiseKey::new(seed, camera, frame, capture, purpose).stream(pixel)
    }

    /// Returns the stream `number` of a 64-bit key, distinct from those of all pixels: no image has such a row.
    fn from_key(key: u64, number: u32) -> Self {
        Self { key: [key as u32, (key >> 32) as u32], counter: [0, 0, number, u32::MAX], words: [0; 4], used: 4 }
    }

    /// The next 32 bits.
    #[inline]
    pub fn word(&mut self) -> u32 {
        if self.used == 4 {
            self.words = philox4x32(self.counter, self.key);
            self.counter[0] = self.counter[0].wrapping_add(1);
            self.used = 0;
        }
        self.used += 1;
        self.words[self.used - 1]
    }

    /// The next 64 bits.
    #[inline]
    pub fn double_word(&mut self) -> u64 {
        let low = u64::from(self.word());
        low | u64::from(self.word()) << 32
    }

    /// The next number in [0, 1), of 24 bits.
    #[inline]
    pub fn unit_f32(&mut self) -> f32 {
        unit_f32(self.word())
    }

    /// The next number in [0, 1), of 53 bits.
    #[inline]
    pub fn unit_f64(&mut self) -> f64 {
        unit_f64(self.double_word())
    }
}

impl TryRng for NoiseStream {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.word())
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.double_word())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(4) {
            let word = self.word().to_le_bytes();
            chunk.copy_from_slice(&word[..chunk.len()]);
        }
        Ok(())
    }
}

/// FNV-1a of 64 bits (Fowler, Noll, Vo). Its low bits are well distributed; its high ones are not.
fn hash(name: &str) -> u64 {
    name.bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Returns a number in [0, 1) that depends on a name alone, whatever the seed: for properties of the scene, not of its rendering.
#[must_use]
pub fn number_of_name(name: &str) -> f64 {
    unit_f64(mix(mix(hash(name))))
}

/// Returns a stream of independent words that depends on a name, a seed and a number: for repeated independent variations.
#[must_use]
pub fn stream_of_name(seed: u64, name: &str, number: u32) -> NoiseStream {
    NoiseStream::from_key(mix(mix(seed ^ 0x6a09_e667_f3bc_c908) ^ mix(hash(name))), number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_pinned() {
        let mut stream = NoiseStream::new(7, 1, 2, 0, Pixel { x: 3, y: 5 }, NoiseDraw::Read);
        assert_eq!([stream.word(), stream.word(), stream.word(), stream.word(), stream.word()], PINNED);
    }

    const PINNED: [u32; 5] = [2_236_171_142, 2_991_702_815, 2_159_987_644, 4_221_248_966, 1_504_178_408];

    #[test]
    fn numbers_of_names_are_pinned_and_uniform() {
        assert_eq!(
            number_of_name("lamp 1").to_bits(),
            4_605_092_711_475_627_217,
            "a changed number changes scenes: is it meant?"
        );
        let mut bins = [0_u32; 16];
        (0..16_000).for_each(|i| bins[(number_of_name(&format!("street lamp {i}")) * 16.0) as usize] += 1);
        // 1 000 per bin, standard deviation 31.
        assert!(bins.iter().all(|bin| bin.abs_diff(1000) < 5 * 31), "{bins:?}");
    }

    #[test]
    fn streams_of_names_differ_by_seed_name_and_number() {
        let first = |seed, name, number| stream_of_name(seed, name, number).double_word();
        let all = [first(7, "a.b", 5), first(8, "a.b", 5), first(7, "a.c", 5), first(7, "a.b", 6)];
        assert!((1..4).all(|i| all[..i].iter().all(|other| *other != all[i])), "{all:?}");
        assert_eq!(all[0], first(7, "a.b", 5));
    }
}
