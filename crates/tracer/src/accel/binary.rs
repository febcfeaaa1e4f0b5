//! Binary trees, as their builders leave them.

use super::boxes::Box3;

/// Marks a leaf.
const LEAF: u32 = 1 << 31;

/// A node of a binary tree: the parent of two nodes, or a leaf of one primitive. 28 bytes.
///
/// A tree's nodes stand in one order: its root; below an inner node its two children, one after the other, then all that is
/// below the first, then all that is below the second. So parents come before their children, and everything below a node
/// stands together.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Box3,
    word: u32,
}

/// What a binary node holds.
#[derive(Clone, Copy, Debug)]
pub(super) enum BinaryKind {
    /// Its two children are this node and the next.
    Inner(u32),
    /// A primitive.
    Leaf(u32),
}

impl BinaryNode {
    pub(super) fn new(bounds: Box3, kind: BinaryKind) -> Self {
        let word = match kind {
            BinaryKind::Inner(first) => first,
            BinaryKind::Leaf(primitive) => primitive | LEAF,
        };
        Self { bounds, word }
    }

    #[inline(always)]
    pub(super) fn kind(&self) -> BinaryKind {
        if self.word & LEAF == 0 { BinaryKind::Inner(self.word) } else { BinaryKind::Leaf(self.word & !LEAF) }
    }
}
