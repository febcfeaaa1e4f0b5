//! Low-discrepancy sequences: Sobol's in two dimensions, multiples of the golden ratio, and a shifted lattice.
//!
//! The first two dimensions of the Sobol sequence, with Owen scrambling by hashing.
//!
//! Laine and Karras 2011 showed that a hash which only carries upwards, between bit reversals, is a nested uniform (Owen) scramble; Burley 2020 ("Practical
//! hash-based Owen scrambling", JCGT 9(4)) shuffles the index the same way and pads low dimensions to any number. The constants of the hash are Vegdahl's
//! (2021), which scramble better.

use super::address::{PixelAddress, mix};
use super::unit_f64;

/// Dimension 0 (the van der Corput sequence) at `index`, Owen-scrambled by `seed`; fixed point with 2³² = 1.
#[inline]
pub(super) fn scrambled_0(index: u32, seed: u32) -> u32 {
    upward_hash(index, seed).reverse_bits()
}

/// Dimensions 0 and 1 at `index`, Owen-scrambled by a seed each; fixed point with 2³² = 1. Both are reversed at once.
#[inline]
pub(super) fn scrambled_pair(index: u32, seed_0: u32, seed_1: u32) -> (u32, u32) {
    let (low, high) = (upward_hash(mirrored_1(index), seed_1), upward_hash(index, seed_0));
    let both = (u64::from(low) | u64::from(high) << 32).reverse_bits();
    (both as u32, (both >> 32) as u32)
}

/// Shuffles indices and keeps every aligned power-of-two block together, so prefixes stay well distributed. The index has its bits reversed.
#[inline]
pub(super) fn shuffle_mirrored(mirrored: u32, seed: u32) -> u32 {
    upward_hash(mirrored, seed).reverse_bits()
}

/// Dimension 1 with its bits reversed. Its matrix is Pascal's triangle modulo 2, the Kronecker power of a triangle of ones; it is applied by doubling steps.
#[inline]
fn mirrored_1(index: u32) -> u32 {
    let mut x = index;
    x ^= (x & 0xaaaa_aaaa) >> 1;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^ (x & 0xffff_0000) >> 16
}

#[inline]
fn upward_hash(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Distinguishes the key of these numbers from those of a path and of a lattice.
const GOLDEN: u64 = 0x9e6c_63d0_876a_3f6b;
/// Golden ratio minus 1.
const STEP: f64 = 0.618_033_988_749_894_9;

/// The additive recurrence of the golden ratio with a random shift: neighbours among the first n numbers in [0, 1) are at most 2.6/n apart (three-distance
/// theorem, Sós 1958). Each number alone is uniform. For a number of samples that is not known in advance.
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

/// Distinguishes the key of these numbers from that of a path.
const LATTICE: u64 = 0x5bd1_e995_94d0_49bb;

/// One number in [0, 1) per sample, at equal distances: a lattice of rank 1 with a random shift (Cranley and Patterson 1976). The order is random, so the
/// number is independent of a sample's other numbers. Each alone is uniform.
///
/// An interval of length a holds ⌊n a⌋ or ⌈n a⌉ of n numbers. No power of two is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftedLattice {
    key: u64,
    count: u32,
    /// Fraction of one step, in [0, 1).
    shift: f64,
}

impl ShiftedLattice {
    /// Returns the lattice of `count` numbers (at least 1) of an address; different addresses have independent shifts and orders.
    #[must_use]
    pub fn new(address: &PixelAddress, count: u32) -> Self {
        let key = mix(address.key() ^ LATTICE);
        Self { key, count: count.max(1), shift: unit_f64(mix(key)) }
    }

    /// Returns the number of a sample, below the count.
    #[inline]
    #[must_use]
    pub fn at(&self, sample: u32) -> f64 {
        (f64::from(self.shuffled(sample)) + self.shift) / f64::from(self.count)
    }

    /// Permutation of 0 … count − 1: one of the next power of two, repeated until the value falls below the count (cycle walking).
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

    /// Bijection of the numbers of `mask`: each step is a bijection (an odd product, a sum, a shift to the right folded in).
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
    use super::super::{FrameAddress, Pixel};
    use super::*;

    /// The direct definition of dimension 1: columns of Pascal's triangle modulo 2.
    fn sobol_1_by_columns(index: u32) -> u32 {
        let mut column = 1_u32 << 31;
        let mut x = 0;
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                x ^= column;
            }
            column ^= column >> 1;
        }
        x
    }

    #[test]
    fn dimension_one_is_the_matrix_of_binomials() {
        for index in (0..70_000).chain([u32::MAX, 0x8000_0000, 0xdead_beef]) {
            assert_eq!(mirrored_1(index).reverse_bits(), sobol_1_by_columns(index), "{index}");
        }
    }

    #[test]
    fn scrambled_points_fill_every_elementary_interval() {
        for seed in [0, 1, 0xdead_beef, 77] {
            for (a, b) in [(4_u32, 4_u32), (8, 0), (0, 8), (2, 6), (5, 3)] {
                let mut is_used = [false; 256];
                for i in 0..256 {
                    let index = shuffle_mirrored(u32::reverse_bits(i), seed ^ 0x55);
                    let (x, y) = scrambled_pair(index, seed, seed.wrapping_mul(31) ^ 0x1234_5678);
                    assert_eq!(x, scrambled_0(index, seed));
                    let column = if a == 0 { 0 } else { x >> (32 - a) };
                    let row = if b == 0 { 0 } else { y >> (32 - b) };
                    is_used[(column << b | row) as usize] = true;
                }
                assert!(is_used.iter().all(|s| *s), "seed {seed}, 2^-{a} × 2^-{b}");
            }
        }
    }

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
        // 200 per bin, standard deviation 13.8.
        assert!(bins.iter().all(|b| (f64::from(*b) - 200.0).abs() < 5.0 * 13.8), "{bins:?}");
    }

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
            let mut is_used = vec![0; count as usize];
            numbers(3, count).iter().for_each(|u| is_used[(u * f64::from(count)) as usize] += 1);
            assert!(is_used.iter().all(|n| *n == 1), "{count}");
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
        // 166.7 per bin, standard deviation 12.6.
        assert!(bins.iter().all(|b| (f64::from(*b) - 166.7).abs() < 5.0 * 12.6), "{bins:?}");
        // Two different places of twelve: covariance −1/12 of the variance of one, 1/12; standard deviation 0.0013.
        assert!((product / f64::from(n) + 1.0 / 144.0).abs() < 0.0066, "{product}");
    }
}
