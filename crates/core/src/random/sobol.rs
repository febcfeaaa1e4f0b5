//! The first two dimensions of the Sobol sequence, with Owen scrambling by hashing.
//!
//! Laine and Karras 2011 showed that a hash which only carries upwards, between bit reversals, is a nested uniform
//! (Owen) scramble; Burley 2020 ("Practical hash-based Owen scrambling", JCGT 9(4)) shuffles the index the same way
//! and pads low dimensions to any number. The constants of the hash are Vegdahl's (2021), which scramble better.

/// Dimension 0 (the van der Corput sequence) at `index`, Owen-scrambled by `seed`; fixed point, 2³² is one.
#[inline]
pub(super) fn scrambled_0(index: u32, seed: u32) -> u32 {
    upward_hash(index, seed).reverse_bits()
}

/// Dimensions 0 and 1 at `index`, Owen-scrambled by a seed each; fixed point, 2³² is one. Both are reversed at once.
#[inline]
pub(super) fn scrambled_pair(index: u32, seed_0: u32, seed_1: u32) -> (u32, u32) {
    let (low, high) = (upward_hash(mirrored_1(index), seed_1), upward_hash(index, seed_0));
    let both = (u64::from(low) | u64::from(high) << 32).reverse_bits();
    (both as u32, (both >> 32) as u32)
}

/// A shuffle of indices that keeps every aligned power-of-two block together, so prefixes stay well distributed. The
/// index is given with its bits reversed.
#[inline]
pub(super) fn shuffle_mirrored(mirrored: u32, seed: u32) -> u32 {
    upward_hash(mirrored, seed).reverse_bits()
}

/// Dimension 1 with its bits reversed: its matrix is Pascal's triangle modulo 2, the Kronecker power of a triangle of
/// ones, and so applied by doubling steps.
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

#[cfg(test)]
mod tests {
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
                let mut seen = [false; 256];
                for i in 0..256 {
                    let index = shuffle_mirrored(u32::reverse_bits(i), seed ^ 0x55);
                    let (x, y) = scrambled_pair(index, seed, seed.wrapping_mul(31) ^ 0x1234_5678);
                    assert_eq!(x, scrambled_0(index, seed));
                    let column = if a == 0 { 0 } else { x >> (32 - a) };
                    let row = if b == 0 { 0 } else { y >> (32 - b) };
                    seen[(column << b | row) as usize] = true;
                }
                assert!(seen.iter().all(|s| *s), "seed {seed}, 2^-{a} × 2^-{b}");
            }
        }
    }
}
