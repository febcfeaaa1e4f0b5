//! Numbers that a seed decides: SplitMix64 (Steele, Lea and Flood 2014).

/// A sequence of numbers.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `count`; 0 of none.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { (self.next() % count as u64) as usize }
    }

    /// Whether the case comes that is one in `count`.
    pub(crate) fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// A small number of at least 1; each next is half as frequent.
    pub(crate) fn few(&mut self) -> usize {
        1 + (self.next() | 1 << 40).trailing_zeros() as usize
    }

    /// A length up to `longest`, short ones as frequent as long ones.
    pub(crate) fn length(&mut self, longest: usize) -> usize {
        let bits = usize::BITS - longest.leading_zeros();
        let below = 1_usize << self.below(bits as usize + 1);
        self.below(below.min(longest) + 1)
    }

    pub(crate) fn choose<'a, T>(&mut self, choices: &'a [T]) -> &'a T {
        &choices[self.below(choices.len())]
    }
}
