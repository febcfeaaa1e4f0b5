//! Through an eight-wide tree.

use super::lanes::{Eight, Lanes};
use super::node::{Child, Node};
use super::pending::{Pending, entry};
use super::ray::{SlabLanes, SlabRay};

/// What happens at a tree's leaves.
pub(super) trait Leaves {
    /// Visits a leaf; may lower the limit. Whether to stop. To be marked `#[inline(always)]`, like all that it calls,
    /// so that it is compiled with the lanes' instructions (closures would not be).
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool;

    /// Where in memory a leaf begins, for asking it ahead.
    fn place(&self, leaf: usize) -> *const u8;
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
    loop {
        let next = match current.as_node() {
            Some(index) => descend::<L, SORTED>(l, nodes, index, &ray, *limit, &mut pending, leaves),
            None if leaves.visit(current.leaf_index(), limit) => return true,
            None => None,
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
    nodes: &[Node],
    index: usize,
    ray: &SlabLanes<L>,
    limit: f32,
    pending: &mut Pending,
    leaves: &impl Leaves,
) -> Option<Child> {
    let node = &nodes[index];
    let (mut lanes, near) = ray.enter(l, node, limit);
    if lanes == 0 {
        return None;
    }
    let first = take::<SORTED>(node, &mut lanes, &near);
    if lanes == 0 {
        return Some(Child::from_word(first as u32));
    }
    pending.reserve();
    let others = Others { node, lanes, near };
    let best = if SORTED { others.nearest(l, nodes, leaves, first, pending) } else { others.last(first, pending) };
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
    fn nearest<L: Lanes>(
        mut self,
        l: L,
        nodes: &[Node],
        leaves: &impl Leaves,
        first: u64,
        pending: &mut Pending,
    ) -> u64 {
        let (mut best, mut count) = (first, 0);
        while self.lanes != 0 {
            let other = take::<true>(self.node, &mut self.lanes, &self.near);
            ask(l, nodes, leaves, best.max(other));
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

/// Asks the memory for what an entry names.
#[inline(always)]
fn ask<L: Lanes>(l: L, nodes: &[Node], leaves: &impl Leaves, entry: u64) {
    let child = Child::from_word(entry as u32);
    let node = nodes.as_ptr().wrapping_add(child.leaf_index()).cast();
    let leaf = leaves.place(child.leaf_index());
    l.prefetch(if child.as_node().is_some() { node } else { leaf });
}
