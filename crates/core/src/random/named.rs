//! Numbers that belong to names.

use super::NoiseStream;
use super::address::mix;
use super::unit_f64;

/// FNV-1a of 64 bits (Fowler, Noll, Vo), whose low bits are well spread and whose high ones are not.
fn hash(name: &str) -> u64 {
    name.bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// A number in [0, 1) that a name has for itself, whatever the seed: for what belongs to the scene and not to its rendering.
#[must_use]
pub fn number_of_name(name: &str) -> f64 {
    unit_f64(mix(mix(hash(name))))
}

/// Independent words that a name has for itself, by a seed and a number: for what is drawn time after time, each time alone.
#[must_use]
pub fn stream_of_name(seed: u64, name: &str, number: u32) -> NoiseStream {
    NoiseStream::of_key(mix(mix(seed ^ 0x6a09_e667_f3bc_c908) ^ mix(hash(name))), number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_names_are_pinned_and_uniform() {
        assert_eq!(
            number_of_name("lamp 1").to_bits(),
            4_605_092_711_475_627_217,
            "a changed number changes scenes: is it meant?"
        );
        let mut bins = [0_u32; 16];
        (0..16_000).for_each(|i| bins[(number_of_name(&format!("street lamp {i}")) * 16.0) as usize] += 1);
        // 1 000 a bin, standard deviation 31.
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
