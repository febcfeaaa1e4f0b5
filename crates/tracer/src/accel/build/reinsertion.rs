//! Better places for subtrees, by the obvhs library. Only this file and the splitting of large triangles use it.
//!
//! Subtrees are removed and inserted where they cost least, repeatedly (Meister, Bittner 2018, "Parallel reinsertion for bounding volume hierarchy
//! optimization"). Most is gained with the largest: below them the tree may stay as it is.

use glam::{DVec3, Vec3};
use obvhs::bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH};
use obvhs::{aabb::Aabb, bvh2::node::Bvh2Node, bvh2::reinsertion::ReinsertionOptimizer};

use crate::accel::boxes::{BinaryKind, BinaryNode, Box3};

/// Maximum number of boxes about one point. The library compares all of them with each other: a thousand times a thousand steps are still
/// negligible.
const MAX_COINCIDENT: usize = 2000;

#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Fraction of the inner nodes, the largest first, that are opened.
    pub(super) opened_fraction: f32,
    /// Fraction of the resulting nodes that is tried for a better place.
    pub(super) tried_fraction: f32,
}

/// A better tree over the same primitives, or the same tree if too many of them coincide.
pub(super) fn optimised(binary: Vec<BinaryNode>, effort: Effort) -> Vec<BinaryNode> {
    if binary.is_empty() || is_crowded(&binary) {
        return binary;
    }
    let mut top = top(&binary, min_area(&binary, effort.opened_fraction));
    ReinsertionOptimizer::default().run(&mut top, effort.tried_fraction, None);
    merge_trees(&top, &binary)
}

/// The area that the given fraction of inner nodes exceeds or reaches.
fn min_area(binary: &[BinaryNode], fraction: f32) -> f32 {
    let is_inner = |node: &&BinaryNode| matches!(node.kind(), BinaryKind::Inner(_));
    let mut areas: Vec<f32> = binary.iter().filter(is_inner).map(|node| node.bounds.half_area()).collect();
    let rank = (areas.len() as f32 * fraction) as usize;
    if rank >= areas.len() {
        return f32::NEG_INFINITY;
    }
    *areas.select_nth_unstable_by(rank, |a, b| b.total_cmp(a)).1
}

/// The inner nodes of `least_area` or more for the library, level by level, since it expects the largest nodes first. The primitives of its
/// leaves are the indices of the nodes below.
fn top(binary: &[BinaryNode], min_area: f32) -> Bvh2 {
    let (mut nodes, mut primitives) = (Vec::new(), Vec::new());
    let (mut level, mut depth) = (vec![0_u32], 0);
    let mut next_place = 1;
    while !level.is_empty() {
        let mut below = Vec::with_capacity(2 * level.len());
        for node in level {
            let own = &binary[node as usize];
            let bounds = Aabb::new(own.bounds.low.into(), own.bounds.high.into());
            nodes.push(match own.kind() {
                BinaryKind::Inner(first) if own.bounds.half_area() >= min_area => {
                    below.extend([first, first + 1]);
                    next_place += 2;
                    Bvh2Node::new(bounds, 0, next_place - 2)
                }
                _ => {
                    primitives.push(node);
                    Bvh2Node::new(bounds, 1, primitives.len() as u32 - 1)
                }
            });
        }
        (level, depth) = (below, depth + 1);
    }
    let max_depth = DEFAULT_MAX_STACK_DEPTH.max(depth);
    Bvh2 { nodes, primitive_indices: primitives, max_depth, ..Bvh2::default() }
}

#[derive(Clone, Copy)]
enum NodeSource {
    Top(u32),
    Below(u32),
}

/// The tree of the library's top and the subtrees below it, in the order of binary trees.
fn merge_trees(top: &Bvh2, binary: &[BinaryNode]) -> Vec<BinaryNode> {
    let bounds = |source| match source {
        NodeSource::Top(node) => {
            let bounds = top.nodes[node as usize].aabb();
            Box3 { low: bounds.min.into(), high: bounds.max.into() }
        }
        NodeSource::Below(node) => binary[node as usize].bounds,
    };
    let unfinished = |source| BinaryNode::new(bounds(source), BinaryKind::Leaf(0));
    let mut nodes = Vec::with_capacity(binary.len());
    nodes.push(unfinished(NodeSource::Top(0)));
    let mut pending = vec![(NodeSource::Top(0), 0_usize)];
    while let Some((source, place)) = pending.pop() {
        let children = match resolved(source, top) {
            NodeSource::Top(node) => {
                let first = top.nodes[node as usize].first_index;
                [NodeSource::Top(first), NodeSource::Top(first + 1)]
            }
            NodeSource::Below(node) => match binary[node as usize].kind() {
                BinaryKind::Inner(first) => [NodeSource::Below(first), NodeSource::Below(first + 1)],
                BinaryKind::Leaf(_) => {
                    nodes[place] = binary[node as usize];
                    continue;
                }
            },
        };
        let first = nodes.len();
        nodes.extend(children.map(unfinished));
        nodes[place] = BinaryNode::new(nodes[place].bounds, BinaryKind::Inner(first as u32));
        pending.extend([(children[1], first + 1), (children[0], first)]);
    }
    nodes
}

/// Replaces a leaf of the top by the subtree below it.
fn resolved(source: NodeSource, top: &Bvh2) -> NodeSource {
    match source {
        NodeSource::Top(node) if top.nodes[node as usize].prim_count > 0 => {
            NodeSource::Below(top.primitive_indices[top.nodes[node as usize].first_index as usize])
        }
        other => other,
    }
}

/// True if more than [`MAX_COINCIDENT`] centres coincide, at a resolution of 2⁻²¹ of the whole.
fn is_crowded(binary: &[BinaryNode]) -> bool {
    let Some(bounds) = binary.first().map(|root| root.bounds).filter(|_| binary.len() > MAX_COINCIDENT) else {
        return false;
    };
    let leaves = binary.iter().filter(|node| matches!(node.kind(), BinaryKind::Leaf(_)));
    let mut cells: Vec<_> = leaves.map(|leaf| cell(leaf.bounds.centre(), &bounds)).collect();
    cells.sort_unstable();
    cells.chunk_by(|a, b| a == b).any(|cell| cell.len() > MAX_COINCIDENT)
}

/// Position of a point in a box, three times 21 bits.
fn cell(point: Vec3, bounds: &Box3) -> u64 {
    let extent = (bounds.high - bounds.low).as_dvec3().max(DVec3::splat(f64::MIN_POSITIVE));
    let steps = (point - bounds.low).as_dvec3() / extent * f64::from((1 << 21) - 1);
    let [x, y, z] = steps.to_array().map(|s| s as u64);
    x << 42 | y << 21 | z
}
