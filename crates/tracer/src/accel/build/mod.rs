//! Trees over triangles and over boxes.
//!
//! - `reference`, `pieces`: padded boxes over which trees are built, several for a large triangle.
//! - `partition`: splits of a range, by the surface area heuristic.
//! - `top_down`: ranges split in two, recursively.
//! - `reinsertion`: better places for subtrees, by the obvhs library.
//!
//! The same boxes give the same tree, whatever the number of threads.

mod partition;
mod reference;
mod reinsertion;
use etendue_core::Accelerator;
use glam::Vec3;

use super::boxes::{BinaryKind, BinaryNode, Box3};
use partition::{ReferenceRange, SplitRanges, cut, halve};
use reference::Reference;
use reinsertion::Effort;

/// For the largest subtrees of a mesh. Twice as many gave 3 % fewer nodes per ray in the street, for 15 % more time to build.
const LARGEST: Effort = Effort { opened_fraction: 0.06, tried_fraction: 1.0 };
/// For half of a mesh's subtrees. All of them, or more of them tried, gave no better trees.
const HALF: Effort = Effort { opened_fraction: 0.5, tried_fraction: 0.3 };
/// For a tree over instances, which are few.
const ALL: Effort = Effort { opened_fraction: 1.0, tried_fraction: 0.2 };

/// A binary tree over triangles with the given corners; empty without triangles. A large triangle may have several leaves.
pub(super) fn over_triangles(
    count: usize,
    corners: impl Fn(u32) -> [Vec3; 3] + Sync,
    quality: Accelerator,
) -> Vec<BinaryNode> {
    let mut references = match quality {
        Accelerator::Fast => reference::unsplit_references(count, &corners),
        Accelerator::Default | Accelerator::Best => reference::split_large(count, &corners),
    };
    let binary = build_top_down(&mut references);
    drop(references);
    match quality {
        Accelerator::Fast => binary,
        Accelerator::Default => reinsertion::optimised(binary, LARGEST),
        Accelerator::Best => reinsertion::optimised(binary, HALF),
    }
}

/// A binary tree over triangles that move, each in its box for the whole interval; empty without triangles. Positions interpolated at times
/// in between may be rounded out of those boxes by a unit in the last place of f32, 1.2e-7 of their coordinates; the padding includes this.
pub(super) fn over_moving(count: usize, swept: impl Fn(u32) -> Box3 + Sync, quality: Accelerator) -> Vec<BinaryNode> {
    let mut references = reference::swept(count, &swept);
    let binary = build_top_down(&mut references);
    match quality {
        Accelerator::Fast => binary,
        Accelerator::Default | Accelerator::Best => reinsertion::optimised(binary, LARGEST),
    }
}

/// A binary tree over boxes; empty without boxes.
pub(super) fn over_boxes(boxes: &[Box3]) -> Vec<BinaryNode> {
    let reference = |(b, number): (&Box3, u32)| Reference::new(&b.grown(b.padding()), number);
    let mut references: Vec<_> = boxes.iter().zip(0..).map(reference).collect();
    reinsertion::optimised(build_top_down(&mut references), ALL)
}

// Trees built from the top down: a range of references is split in two recursively ([`super::partition`]).
//
// The nodes of a subtree have their places before it is built, since a range of n references becomes 2n − 1 nodes. Any thread can therefore
// build any range, and the tree is the same for any number of them.

/// Ranges of fewer references are built by one thread.
const MIN_PARALLEL_REFERENCES: usize = 2048;
/// Depth of splits beyond which ranges are halved by count: primitives nested in ever smaller boxes would otherwise be split off one by
/// one.
const MAX_DEPTH: u32 = 64;

/// The binary tree over references, which change places; empty without references.
fn build_top_down(references: &mut [Reference]) -> Vec<BinaryNode> {
    let range = ReferenceRange::from_references(references);
    let root = BinaryNode::new(range.extent.bounds(), BinaryKind::Leaf(0));
    let mut nodes = vec![root; (2 * references.len()).saturating_sub(1)];
    if let [root, below @ ..] = nodes.as_mut_slice() {
        SubtreePosition { first: 1, depth: 0 }.grow(references, &range, root, below);
    }
    nodes
}

/// Place of the nodes below a node.
#[derive(Clone, Copy)]
struct SubtreePosition {
    /// Index of the first child.
    first: u32,
    depth: u32,
}

impl SubtreePosition {
    /// Builds the node of a range and all that is `below` it.
    fn grow(
        self,
        references: &mut [Reference],
        range: &ReferenceRange,
        node: &mut BinaryNode,
        below: &mut [BinaryNode],
    ) {
        let bounds = range.extent.bounds();
        if let [only] = references {
            *node = BinaryNode::new(bounds, BinaryKind::Leaf(only.primitive()));
            return;
        }
        *node = BinaryNode::new(bounds, BinaryKind::Inner(self.first));
        let SplitRanges { at, ranges: [left_range, right_range] } =
            if self.depth < MAX_DEPTH { cut(references, range) } else { halve(references, range) };
        let (left, right) = references.split_at_mut(at);
        let (children, below) = below.split_at_mut(2);
        let (left_below, right_below) = below.split_at_mut(2 * left.len() - 2);
        let [left_node, right_node] = children else { unreachable!("two children") };
        let (first, depth) = (self.first + 2, self.depth + 1);
        let right_first = first + left_below.len() as u32;
        let is_large = left.len() + right.len() >= MIN_PARALLEL_REFERENCES;
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
