//! Through an eight-wide tree.

use super::lanes::{Eight, Lanes};
use super::node::{Child, Node};
use super::ray::{SlabLanes, SlabRay};
use smallvec::SmallVec;

/// What is still to be visited: where the ray enters it (as bits, which order like the numbers, none being negative)
/// above the child's word. Seven a level of the tree; deeper trees than usual go to the heap.
type Pending = SmallVec<[u64; 128]>;

/// What happens at a tree's leaves.
pub(super) trait Leaves {
    /// Visits a leaf; may lower the limit. Whether to stop. To be marked `#[inline(always)]`, like all that it calls,
    /// so that it is compiled with the lanes' instructions (closures would not be).
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool;
}

/// Visits the leaves that a ray enters at or before `limit`, until a leaf says stop. With
/// `SORTED`, near leaves come before far ones. Whether it was stopped.
#[inline(always)]
pub(super) fn walk<L: Lanes, const SORTED: bool>(
    l: L,
    nodes: &[Node],
    root: Child,
    ray: &SlabRay,
    limit: &mut f32,
    leaves: &mut impl Leaves,
) -> bool {
    let ray = SlabLanes::new(l, ray);
    let mut pending = Pending::new();
    let mut current = root;
    loop {
        let next = match current.as_node() {
            Some(index) => descend::<L, SORTED>(l, nodes, index, &ray, *limit, &mut pending),
            None if leaves.visit(current.leaf_index(), limit) => return true,
            None => None,
        };
        current = match next.or_else(|| pop(&mut pending, *limit)) {
            Some(child) => child,
            None => return false,
        };
    }
}

/// The child to visit next; the others that the ray enters are left pending.
#[inline(always)]
fn descend<L: Lanes, const SORTED: bool>(
    l: L,
    nodes: &[Node],
    index: usize,
    ray: &SlabLanes<L>,
    limit: f32,
    pending: &mut Pending,
) -> Option<Child> {
    let node = &nodes[index];
    let (mut lanes, near) = ray.enter(l, node, limit);
    if lanes == 0 {
        return None;
    }
    let mut best = take(l, nodes, node, &mut lanes, &near);
    let start = pending.len();
    while lanes != 0 {
        let other = take(l, nodes, node, &mut lanes, &near);
        if SORTED {
            pending.push(best.max(other));
            best = best.min(other);
        } else {
            pending.push(other);
        }
    }
    if SORTED {
        far_first(&mut pending[start..]);
    }
    Some(Child::from_word(best as u32))
}

/// Takes the lowest lane out of `lanes`, and asks the memory for the node there.
#[inline(always)]
fn take<L: Lanes>(l: L, nodes: &[Node], node: &Node, lanes: &mut u32, near: &Eight) -> u64 {
    let lane = lanes.trailing_zeros() as usize & 7;
    *lanes &= *lanes - 1;
    let child = node.children[lane];
    if let Some(next) = child.as_node().and_then(|index| nodes.get(index)) {
        l.prefetch(next);
    }
    u64::from(near.0[lane].to_bits()) << 32 | u64::from(child.word())
}

/// Sorts at most seven entries by insertion.
#[inline(always)]
fn far_first(entries: &mut [u64]) {
    for end in 1..entries.len() {
        let mut at = end;
        while at > 0 && entries[at - 1] < entries[at] {
            entries.swap(at - 1, at);
            at -= 1;
        }
    }
}

#[inline(always)]
fn pop(pending: &mut Pending, limit: f32) -> Option<Child> {
    while let Some(entry) = pending.pop() {
        if f32::from_bits((entry >> 32) as u32) <= limit {
            return Some(Child::from_word(entry as u32));
        }
    }
    None
}
