//! Numbers spread evenly over as many samples as there will be.

use super::address::{PixelAddress, mix};
use super::unit_f64;

/// Tells the key of these numbers from those of a path's and of a lattice's.
const GOLDEN: u64 = 0x9e6c_63d0_876a_3f6b;
/// The golden ratio less 1.
const STEP: f64 = 0.618_033_988_749_894_9;

/// The additive recurrence of the golden ratio with a random shift: of any first n numbers in [0, 1) neighbours are at most
/// 2.6/n apart (three-distance theorem, Sós 1958). Each number alone is uniform. For samples whose number is not known before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoldenSequence {
    shift: f64,
}

impl GoldenSequence {
    /// The sequence of an address; different addresses have independent shifts.
    #[must_use]
    pub fn new(address: &PixelAddress) -> Self {
        Self { shift: unit_f64(mix(address.key() ^ GOLDEN)) }
    }

    /// The number of a sample.
    #[inline]
    #[must_use]
    pub fn at(&self, sample: u32) -> f64 {
        (self.shift + f64::from(sample) * STEP).fract()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FrameAddress, Pixel};
    use super::*;

    fn sequence(x: u32) -> GoldenSequence {
        let frame = FrameAddress { seed: 7, ..FrameAddress::default() };
        GoldenSequence::new(&PixelAddress { frame, pixel: Pixel { x, y: 3 }, replicate: 1 })
    }

    #[test]
    fn any_first_numbers_lie_evenly() {
        for n in [2_u32, 3, 7, 16, 100, 1000, 4096] {
            let mut numbers: Vec<f64> = (0..n).map(|sample| sequence(5).at(sample)).collect();
            numbers.sort_by(f64::total_cmp);
            let around = numbers[0] + 1.0 - numbers[numbers.len() - 1];
            let widest = numbers.windows(2).map(|pair| pair[1] - pair[0]).fold(around, f64::max);
            assert!(widest * f64::from(n) < 2.62, "{n}: {widest}");
        }
    }

    #[test]
    fn each_number_alone_is_uniform() {
        let n = 4000;
        let mut bins = [0_u32; 20];
        (0..n).for_each(|x| bins[(sequence(x).at(11) * 20.0) as usize] += 1);
        // 200 a bin, standard deviation 13.8.
        assert!(bins.iter().all(|b| (f64::from(*b) - 200.0).abs() < 5.0 * 13.8), "{bins:?}");
    }
}
