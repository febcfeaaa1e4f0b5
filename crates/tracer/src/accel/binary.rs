//! The nodes of a binary tree, as its builders leave them.

use super::boxes::Box3;

/// A node of a binary tree: the parent of two nodes, or a leaf of one primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Box3,
    pub(super) kind: BinaryKind,
}

/// What a binary node holds.
#[derive(Clone, Copy, Debug)]
pub(super) enum BinaryKind {
    /// Its two children are this node and the next.
    Inner(u32),
    /// A primitive.
    Leaf(u32),
}
