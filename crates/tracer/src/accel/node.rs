//! Eight-wide nodes.

use super::{boxes::Box3, lanes::F32x8};

/// Content of a node's slot: a node or a leaf, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

const LEAF: u32 = 1 << 31;

impl Child {
    pub(super) fn node(index: usize) -> Self {
        Self(index as u32)
    }

    pub(super) fn leaf(index: usize) -> Self {
        Self(index as u32 | LEAF)
    }

    /// The node's index; `None` for a leaf.
    #[inline(always)]
    pub(super) fn as_node(self) -> Option<usize> {
        (self.0 & LEAF == 0).then_some(self.0 as usize)
    }

    /// The leaf's index, of a child that is not a node.
    #[inline(always)]
    pub(super) fn leaf_index(self) -> usize {
        (self.0 & !LEAF) as usize
    }

    #[inline(always)]
    pub(super) fn word(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) fn from_word(word: u32) -> Self {
        Self(word)
    }
}

/// Eight boxes and their contents; four cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// For each axis, the boxes' minimum coordinates, then their maximum.
    pub(super) planes: [F32x8; 6],
    pub(super) children: [Child; 8],
}

impl Node {
    /// A node without children.
    pub(super) const EMPTY: Self = {
        let [low, high] = [F32x8([f32::INFINITY; 8]), F32x8([f32::NEG_INFINITY; 8])];
        Self { planes: [low, high, low, high, low, high], children: [Child(LEAF); 8] }
    };

    /// Puts a child into a slot.
    pub(super) fn set(&mut self, slot: usize, bounds: &Box3, child: Child) {
        for axis in 0..3 {
            self.planes[2 * axis].0[slot] = bounds.low[axis];
            self.planes[2 * axis + 1].0[slot] = bounds.high[axis];
        }
        self.children[slot] = child;
    }
}
