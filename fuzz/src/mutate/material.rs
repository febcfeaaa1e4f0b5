//! What an input is made of, and parts of it.

use crate::random::Random;

/// Longest input, bytes.
pub(super) const MAX_LENGTH: usize = 1 << 20;

/// What an input is made of.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// Inputs that are changed and mixed; at least one.
    pub inputs: &'a [Vec<u8>],
    /// Words that mean something to the reader.
    pub words: &'a [&'a str],
    /// Whether the reader takes text.
    pub is_text: bool,
}

/// The first and the end of a part of `length` bytes or less.
pub(super) fn part(length: usize, random: &mut Random) -> std::ops::Range<usize> {
    let start = random.below(length + 1);
    start..start + random.length(length - start)
}
