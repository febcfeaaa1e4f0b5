//! What a walk has still to visit.

use super::node::Child;

/// Entries at hand; those of deeper trees than usual go to the heap.
const AT_HAND: usize = 32;
/// Entries that a node adds at most.
const A_NODE: usize = 7;

/// A stack of entries. An entry is where the ray enters a child (as bits, which order like the numbers, none being
/// negative) above the child's word.
pub(super) struct Pending {
    at_hand: [u64; AT_HAND],
    count: usize,
    deep: Vec<u64>,
}

impl Default for Pending {
    #[inline(always)]
    fn default() -> Self {
        Self { at_hand: [0; AT_HAND], count: 0, deep: Vec::new() }
    }
}

/// The entry of a child that the ray enters at `near`.
#[inline(always)]
pub(super) fn entry(near: f32, child: Child) -> u64 {
    u64::from(near.to_bits()) << 32 | u64::from(child.word())
}

impl Pending {
    /// Makes room for a node's entries.
    #[inline(always)]
    pub(super) fn reserve(&mut self) {
        if self.count > AT_HAND - A_NODE {
            self.deepen();
        }
    }

    #[cold]
    #[inline(never)]
    fn deepen(&mut self) {
        self.deep.extend_from_slice(&self.at_hand[..self.count]);
        self.count = 0;
    }

    /// Adds an entry, for which there is room.
    #[inline(always)]
    pub(super) fn push(&mut self, entry: u64) {
        self.at_hand[self.count % AT_HAND] = entry;
        self.count += 1;
    }

    /// Sorts the entries added last, at most seven, by insertion: the nearest will be taken first.
    #[inline(always)]
    pub(super) fn sort_last(&mut self, count: usize) {
        let entries = &mut self.at_hand[self.count - count..self.count];
        for end in 1..entries.len() {
            let mut at = end;
            while at > 0 && entries[at - 1] < entries[at] {
                entries.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    /// Takes the entries added last until one begins at or before `limit`.
    #[inline(always)]
    pub(super) fn pop(&mut self, limit: f32) -> Option<Child> {
        loop {
            let entry = if self.count > 0 {
                self.count -= 1;
                self.at_hand[self.count % AT_HAND]
            } else {
                self.deep.pop()?
            };
            if f32::from_bits((entry >> 32) as u32) <= limit {
                return Some(Child::from_word(entry as u32));
            }
        }
    }
}
