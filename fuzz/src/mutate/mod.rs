//! How an input is made of others.

mod bytes;
mod material;
mod numbers;
mod png_checksum;
mod text;

pub use material::Material;

use crate::random::Random;
use material::MAX_LENGTH;

/// Makes inputs; the same seed makes the same.
#[derive(Clone, Debug)]
pub struct Mutator {
    random: Random,
}

impl Mutator {
    /// The sequence of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { random: Random::new(seed) }
    }

    /// The next input.
    pub fn next(&mut self, material: Material<'_>) -> Vec<u8> {
        let random = &mut self.random;
        let mut input = random.choose(material.inputs).clone();
        for _ in 0..random.few().min(12) {
            let as_text = if material.is_text { !random.one_in(4) } else { random.one_in(12) };
            if as_text {
                text::change(&mut input, material, random);
            } else {
                bytes::change(&mut input, material, random);
            }
        }
        if !random.one_in(4) {
            png_checksum::correct(&mut input);
        }
        input.truncate(MAX_LENGTH);
        input
    }
}
