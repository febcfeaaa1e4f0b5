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
const CROWD: usize = 2000;

#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Fraction of the inner nodes, the largest first, that are opened.
    pub(super) apart: f32,
    /// Fraction of the resulting nodes that is tried for a better place.
    pub(super) tried: f32,
}

/// A better tree over the same primitives, or the same tree if too many of them coincide.
pub(super) fn improved(binary: Vec<BinaryNode>, effort: Effort) -> Vec<BinaryNode> {
    if binary.is_empty() || is_crowded(&binary) {
        return binary;
    }
    let mut top = top(&binary, least_area(&binary, effort.apart));
    ReinsertionOptimizer::default().run(&mut top, effort.tried, None);
    put_together(&top, &binary)
}

/// The area that the given fraction of inner nodes exceeds or reaches.
fn least_area(binary: &[BinaryNode], share: f32) -> f32 {
    let is_inner = |node: &&BinaryNode| matches!(node.kind(), BinaryKind::Inner(_));
    let mut areas: Vec<f32> = binary.iter().filter(is_inner).map(|node| node.bounds.half_area()).collect();
    let rank = (areas.len() as f32 * share) as usize;
    if rank >= areas.len() {
        return f32::NEG_INFINITY;
    }
    *areas.select_nth_unstable_by(rank, |a, b| b.total_cmp(a)).1
}

/// The inner nodes of `least_area` or more for the library, level by level, since it expects the largest nodes first. The primitives of its
/// leaves are the indices of the nodes below.
fn top(binary: &[BinaryNode], least_area: f32) -> Bvh2 {
    let (mut nodes, mut primitives) = (Vec::new(), Vec::new());
    let (mut level, mut depth) = (vec![0_u32], 0);
    let mut next_place = 1;
    while !level.is_empty() {
        let mut below = Vec::with_capacity(2 * level.len());
        for node in level {
            let own = &binary[node as usize];
            let bounds = Aabb::new(own.bounds.low.into(), own.bounds.high.into());
            nodes.push(match own.kind() {
                BinaryKind::Inner(first) if own.bounds.half_area() >= least_area => {
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
enum Source {
    Top(u32),
    Below(u32),
}

/// The tree of the library's top and the subtrees below it, in the order of binary trees.
fn put_together(top: &Bvh2, binary: &[BinaryNode]) -> Vec<BinaryNode> {
    let bounds = |source| match source {
        Source::Top(node) => {
            let bounds = top.nodes[node as usize].aabb();
            Box3 { low: bounds.min.into(), high: bounds.max.into() }
        }
        Source::Below(node) => binary[node as usize].bounds,
    };
    let unfinished = |source| BinaryNode::new(bounds(source), BinaryKind::Leaf(0));
    let mut whole = Vec::with_capacity(binary.len());
    whole.push(unfinished(Source::Top(0)));
    let mut pending = vec![(Source::Top(0), 0_usize)];
    while let Some((source, place)) = pending.pop() {
        let children = match resolved(source, top) {
            Source::Top(node) => {
                let first = top.nodes[node as usize].first_index;
                [Source::Top(first), Source::Top(first + 1)]
            }
            Source::Below(node) => match binary[node as usize].kind() {
                BinaryKind::Inner(first) => [Source::Below(first), Source::Below(first + 1)],
                BinaryKind::Leaf(_) => {
                    whole[place] = binary[node as usize];
                    continue;
                }
            },
        };
        let first = whole.len();
        whole.extend(children.map(unfinished));
        whole[place] = BinaryNode::new(whole[place].bounds, BinaryKind::Inner(first as u32));
        pending.extend([(children[1], first + 1), (children[0], first)]);
    }
    whole
}

/// Replaces a leaf of the top by the subtree below it.
fn resolved(source: Source, top: &Bvh2) -> Source {
    match source {
        Source::Top(node) if top.nodes[node as usize].prim_count > 0 => {
            Source::Below(top.primitive_indices[top.nodes[node as usize].first_index as usize])
        }
        other => other,
    }
}

/// True if more than [`CROWD`] centres coincide, at a resolution of 2⁻²¹ of the whole.
fn is_crowded(binary: &[BinaryNode]) -> bool {
    let Some(whole) = binary.first().map(|root| root.bounds).filter(|_| binary.len() > CROWD) else { return false };
    let leaves = binary.iter().filter(|node| matches!(node.kind(), BinaryKind::Leaf(_)));
    let mut cells: Vec<_> = leaves.map(|leaf| cell(leaf.bounds.centre(), &whole)).collect();
    cells.sort_unstable();
    cells.chunk_by(|a, b| a == b).any(|cell| cell.len() > CROWD)
}

/// Position of a point in a box, three times 21 bits.
fn cell(point: Vec3, whole: &Box3) -> u64 {
    let extent = (whole.high - whole.low).as_dvec3().max(DVec3::splat(f64::MIN_POSITIVE));
    let steps = (point - whole.low).as_dvec3() / extent * f64::from((1 << 21) - 1);
    let [x, y, z] = steps.to_array().map(|s| s as u64);
    x << 42 | y << 21 | z
}
