//! Numbers spread evenly over samples, however many they are.

use super::address::{PixelAddress, mix};
use super::unit_f64;

/// Tells the key of these numbers from those of a path's.
const LATTICE: u64 = 0x5bd1_e995_94d0_49bb;

/// As many numbers in [0, 1) as there are samples, at equal distances: a lattice of rank 1 with a random shift (Cranley and
/// Patterson 1976), taken in a random order so that it says nothing of a sample's other numbers. Each alone is uniform.
///
/// An interval of length a holds ⌊n a⌋ or ⌈n a⌉ of n numbers. No power of two is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftedLattice {
    key: u64,
    count: u32,
    /// Of one step, in [0, 1).
    shift: f64,
}

impl ShiftedLattice {
    /// `count` numbers (at least 1) of an address; different addresses have independent shifts and orders.
    #[must_use]
    pub fn new(address: &PixelAddress, count: u32) -> Self {
        let key = mix(address.key() ^ LATTICE);
        Self { key, count: count.max(1), shift: unit_f64(mix(key)) }
    }

    /// The number of a sample, below the count.
    #[inline]
    #[must_use]
    pub fn at(&self, sample: u32) -> f64 {
        (f64::from(self.shuffled(sample)) + self.shift) / f64::from(self.count)
    }

    /// A permutation of 0 … count − 1: one of the next power of two, walked until it falls below the count.
    #[inline]
    fn shuffled(&self, sample: u32) -> u32 {
        let mask = self.count.next_power_of_two() - 1;
        let mut i = sample % self.count;
        loop {
            i = self.scattered(i, mask);
            if i < self.count {
                return i;
            }
        }
    }

    /// A bijection of the numbers of `mask`: each step is one (an odd product, a sum, a shift to the right folded in).
    #[inline]
    fn scattered(&self, i: u32, mask: u32) -> u32 {
        let bits = mask.count_ones();
        let mut x = i;
        for round in 0..4_u64 {
            let word = mix(self.key.wrapping_add(round));
            x = x.wrapping_mul(word as u32 | 1).wrapping_add((word >> 32) as u32) & mask;
            x ^= x >> (bits / 2).max(1);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::super::Pixel;
    use super::*;
    use crate::random::FrameAddress;

    fn numbers(x: u32, count: u32) -> Vec<f64> {
        let pixel = Pixel { x, y: 5 };
        let address =
            PixelAddress { frame: FrameAddress { seed: 7, camera: 1, ..FrameAddress::default() }, pixel, replicate: 0 };
        let even = ShiftedLattice::new(&address, count);
        (0..count).map(|sample| even.at(sample)).collect()
    }

    #[test]
    fn every_step_holds_one_number() {
        for count in [1, 2, 3, 12, 16, 48, 100, 1000, 1024] {
            let mut seen = vec![0; count as usize];
            numbers(3, count).iter().for_each(|u| seen[(u * f64::from(count)) as usize] += 1);
            assert!(seen.iter().all(|n| *n == 1), "{count}");
        }
    }

    #[test]
    fn each_number_alone_is_uniform_and_the_order_says_nothing() {
        let (n, count) = (4000, 12);
        let mut bins = [0_u32; 24];
        let mut product = 0.0;
        for x in 0..n {
            let u = numbers(x, count);
            bins[(u[5] * 24.0) as usize] += 1;
            product += (u[0] - 0.5) * (u[1] - 0.5);
        }
        // 166.7 a bin, standard deviation 12.6.
        assert!(bins.iter().all(|b| (f64::from(*b) - 166.7).abs() < 5.0 * 12.6), "{bins:?}");
        // Two different places of twelve: −1/12 of the variance of one, 1/12; standard deviation 0.0013.
        assert!((product / f64::from(n) + 1.0 / 144.0).abs() < 0.0066, "{product}");
    }
}
