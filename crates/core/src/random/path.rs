//! Random numbers of one path, stratified over the samples of a replicate.

use glam::Vec2;

use super::address::{Draw, PixelAddress, mix};
use super::sequences::{scrambled_0, scrambled_pair, shuffle_mirrored};
use super::unit_f32;

/// Random numbers of one sample: Owen-scrambled Sobol points, padded in pairs.
///
/// The samples 0, 1, 2, … of one [`PixelAddress`] form, for each draw, a scrambled (0, 2)-sequence in base 2; different draws, pixels and replicates are
/// scrambled independently. Variance must therefore come from the means of replicates: the naive s²/n over the samples of one replicate overstates it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStream {
    key: u64,
    /// The sample's number with its bits reversed.
    mirrored: u32,
}

impl PathStream {
    /// Returns the numbers of sample `sample` of a pixel's replicate.
    #[must_use]
    pub fn new(address: &PixelAddress, sample: u32) -> Self {
        Self { key: address.key(), mirrored: sample.reverse_bits() }
    }

    /// Returns the numbers of another sample of the same pixel and replicate.
    #[inline]
    #[must_use]
    pub fn with_sample(self, sample: u32) -> Self {
        Self { mirrored: sample.reverse_bits(), ..self }
    }

    /// Returns the numbers of one of the `of` equal branches of a sample. They are the numbers of a set with `of` times as many samples, so the branches of all
    /// samples are as well distributed as samples are.
    #[inline]
    #[must_use]
    pub fn branch(self, branch: u32, of: u32) -> Self {
        self.with_sample(self.sample().wrapping_mul(of).wrapping_add(branch))
    }

    /// Index of the sample within its pixel and replicate.
    #[inline]
    #[must_use]
    pub fn sample(&self) -> u32 {
        self.mirrored.reverse_bits()
    }

    /// Returns a number in [0, 1) for `draw`; `sub` distinguishes vertices and repetitions.
    #[inline]
    #[must_use]
    pub fn one(&self, purpose: Draw, sub: u32) -> f32 {
        let key = self.draw_key(purpose, sub);
        let index = shuffle_mirrored(self.mirrored, key as u32);
        unit_f32(scrambled_0(index, (key >> 32) as u32))
    }

    /// Returns a point of the unit square for `draw`. It shares numbers with [`PathStream::one`] of the same draw: each draw uses only one of the two.
    #[inline]
    #[must_use]
    pub fn two(&self, purpose: Draw, sub: u32) -> Vec2 {
        let key = self.draw_key(purpose, sub);
        let index = shuffle_mirrored(self.mirrored, key as u32);
        let (x, y) = scrambled_pair(index, (key >> 32) as u32, mix(key) as u32);
        Vec2::new(unit_f32(x), unit_f32(y))
    }

    #[inline]
    fn draw_key(&self, purpose: Draw, sub: u32) -> u64 {
        mix(self.key ^ (u64::from(purpose as u32) << 32 | u64::from(sub)).wrapping_mul(0xd6e8_feb8_6659_fd93))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Pixel;
    use super::*;
    use crate::random::FrameAddress;

    fn address() -> PixelAddress {
        PixelAddress {
            frame: FrameAddress { seed: 7, camera: 1, frame: 2, ..FrameAddress::default() },
            pixel: Pixel { x: 3, y: 5 },
            replicate: 1,
        }
    }

    #[test]
    fn values_are_pinned() {
        let stream = PathStream::new(&address(), 11);
        let actual = [stream.one(Draw::Wavelength, 0), stream.one(Draw::Roulette, 4)].map(f32::to_bits);
        let pair = stream.two(Draw::Pupil, 0).to_array().map(f32::to_bits);
        assert_eq!((address().key(), actual, pair), PINNED, "a changed stream changes every picture: is it meant?");
    }

    const PINNED: (u64, [u32; 2], [u32; 2]) =
        (786_205_847_091_662_964, [1_061_634_508, 1_062_367_441], [1_051_374_640, 1_061_576_485]);

    #[test]
    fn draws_are_uncorrelated() {
        let n = 4096;
        let stream = PathStream::new(&address(), 0);
        let pairs = [
            (Draw::LightPoint, 0, Draw::LightPoint, 1),
            (Draw::LightPoint, 0, Draw::BsdfDirection, 0),
            (Draw::Pupil, 0, Draw::PixelArea, 0),
        ];
        for (a, i, b, j) in pairs {
            let covariance: f64 = (0..n)
                .map(|s| {
                    let s = stream.with_sample(s);
                    f64::from(s.two(a, i).x - 0.5) * f64::from(s.two(b, j).x - 0.5)
                })
                .sum::<f64>()
                / f64::from(n);
            // Independent points would scatter by 1/(12 √n) = 0.0013; five of those.
            assert!(covariance.abs() < 0.0065, "{a:?} {b:?}: {covariance}");
        }
    }
}
