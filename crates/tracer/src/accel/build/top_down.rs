//! Trees from the top down: a range of references is cut in two again and again ([`super::partition`]).
//!
//! What is below a node has its place before it is built, since a range of n references becomes 2n − 1 nodes: so any thread
//! can build any range, and the tree is the same for any number of them.

use super::partition::{Cut, Range, cut, halve};
use super::reference::Reference;
use crate::accel::binary::{BinaryKind, BinaryNode};

/// Ranges of fewer references are built by one thread.
const ALONE: usize = 2048;
/// Cuts one below the other, after which ranges are halved by number: what lies within each other in ever smaller boxes
/// would be cut off one by one.
const DEEPEST: u32 = 64;

/// The binary tree over references, which change places; empty without references.
pub(super) fn build(references: &mut [Reference]) -> Vec<BinaryNode> {
    let range = Range::of(references);
    let root = BinaryNode::new(range.extent.bounds(), BinaryKind::Leaf(0));
    let mut nodes = vec![root; (2 * references.len()).saturating_sub(1)];
    if let [root, below @ ..] = nodes.as_mut_slice() {
        Growth { first: 1, depth: 0 }.grow(references, &range, root, below);
    }
    nodes
}

/// Where what is below a node stands.
#[derive(Clone, Copy)]
struct Growth {
    /// Index of the first child.
    first: u32,
    /// Cuts above.
    depth: u32,
}

impl Growth {
    /// Builds the node of a range and all that is `below` it.
    fn grow(self, references: &mut [Reference], range: &Range, node: &mut BinaryNode, below: &mut [BinaryNode]) {
        let bounds = range.extent.bounds();
        if let [only] = references {
            *node = BinaryNode::new(bounds, BinaryKind::Leaf(only.primitive()));
            return;
        }
        *node = BinaryNode::new(bounds, BinaryKind::Inner(self.first));
        let Cut { at, ranges: [left_range, right_range] } =
            if self.depth < DEEPEST { cut(references, range) } else { halve(references, range) };
        let (left, right) = references.split_at_mut(at);
        let (children, below) = below.split_at_mut(2);
        let (left_below, right_below) = below.split_at_mut(2 * left.len() - 2);
        let [left_node, right_node] = children else { unreachable!("two children") };
        let (first, depth) = (self.first + 2, self.depth + 1);
        let right_first = first + left_below.len() as u32;
        let is_large = left.len() + right.len() >= ALONE;
        let mut left = || Self { first, depth }.grow(left, &left_range, left_node, left_below);
        let mut right = || Self { first: right_first, depth }.grow(right, &right_range, right_node, right_below);
        if is_large {
            rayon::join(left, right);
        } else {
            left();
            right();
        }
    }
}
