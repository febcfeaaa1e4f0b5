//! Through an eight-wide tree.

use super::lanes::{Eight, Lanes, Visit};
use super::node::{Child, Node};
use super::pending::{Pending, entry};
use super::ray::{SlabLanes, SlabRay};

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
    let mut pending = Pending::default();
    let mut current = root;
    let mut limits = l.splat(*limit);
    loop {
        let next = match current.as_node() {
            Some(index) => descend::<L, SORTED>(l, &nodes[index], &ray, limits, &mut pending),
            None if leaves.visit(current.leaf_index(), limit) => return true,
            None => {
                limits = l.splat(*limit);
                None
            }
        };
        current = match next.or_else(|| pending.pop(*limit)) {
            Some(child) => child,
            None => return false,
        };
    }
}

/// The child to visit next; the others that the ray enters are left pending.
#[inline(always)]
fn descend<L: Lanes, const SORTED: bool>(
    l: L,
    node: &Node,
    ray: &SlabLanes<L>,
    limits: L::V,
    pending: &mut Pending,
) -> Option<Child> {
    l.note(Visit::Node);
    let (mut lanes, near) = ray.enter(l, node, limits);
    if lanes == 0 {
        return None;
    }
    let first = take::<SORTED>(node, &mut lanes, &near);
    if lanes == 0 {
        return Some(Child::from_word(first as u32));
    }
    pending.reserve();
    let others = Others { node, lanes, near };
    let best = if SORTED { others.nearest(first, pending) } else { others.last(first, pending) };
    Some(Child::from_word(best as u32))
}

/// What a ray enters of a node, from the second lane on.
struct Others<'a> {
    node: &'a Node,
    lanes: u32,
    near: Eight,
}

impl Others<'_> {
    /// The nearest, `first` included; the others are left pending, the nearer to be taken earlier.
    #[inline(always)]
    fn nearest(mut self, first: u64, pending: &mut Pending) -> u64 {
        let (mut best, mut count) = (first, 0);
        while self.lanes != 0 {
            let other = take::<true>(self.node, &mut self.lanes, &self.near);
            pending.push(best.max(other));
            best = best.min(other);
            count += 1;
        }
        if count > 1 {
            pending.sort_last(count);
        }
        best
    }

    /// The last; the others are left pending, the last to be taken first.
    #[inline(always)]
    fn last(mut self, first: u64, pending: &mut Pending) -> u64 {
        let mut best = first;
        while self.lanes != 0 {
            pending.push(best);
            best = take::<false>(self.node, &mut self.lanes, &self.near);
        }
        best
    }
}

/// Takes the lowest lane out of `lanes`: where the ray enters it, if that matters, and the child.
#[inline(always)]
fn take<const SORTED: bool>(node: &Node, lanes: &mut u32, near: &Eight) -> u64 {
    let lane = lanes.trailing_zeros() as usize & 7;
    *lanes &= *lanes - 1;
    entry(if SORTED { near.0[lane] } else { 0.0 }, node.children[lane])
}
