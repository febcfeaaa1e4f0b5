//! Numbers that belong to names.

use super::address::mix;
use super::unit_f64;

/// A number in [0, 1) that a name has for itself, whatever the seed: for what belongs to the scene and not to its rendering.
#[must_use]
pub fn number_of_name(name: &str) -> f64 {
    // FNV-1a of 64 bits (Fowler, Noll, Vo), whose low bits are well spread and whose high ones are not.
    let hash = name
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    unit_f64(mix(mix(hash)))
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
}
