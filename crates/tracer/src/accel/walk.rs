//! Traversal of an eight-wide tree.

use super::lanes::{F32x8, Lanes, Visit};
use super::node::{Child, Node};
use super::ray::{SlabLanes, SlabRay};

/// Action at a tree's leaves.
pub(super) trait Leaves {
    /// Visits a leaf; may lower the limit. Returns true to stop. Mark it `#[inline(always)]`, like everything it calls, so that it is
    /// compiled with the lanes' instructions (closures would not be).
    fn visit(&mut self, leaf: usize, limit: &mut f32) -> bool;
}

/// Visits the leaves that a ray enters at or before `limit`, until a leaf returns true. With `SORTED`, near leaves come before far ones.
/// Returns true if it was stopped.
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
    let mut pending = PendingNodes::default();
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
    pending: &mut PendingNodes,
) -> Option<Child> {
    l.record_visit(Visit::Node);
    let (mut lanes, near) = ray.enter(l, node, limits);
    if lanes == 0 {
        return None;
    }
    let first = take::<SORTED>(node, &mut lanes, &near);
    if lanes == 0 {
        return Some(Child::from_word(first as u32));
    }
    pending.reserve();
    let others = PendingQueue { node, lanes, near };
    let best = if SORTED { others.nearest(first, pending) } else { others.last(first, pending) };
    Some(Child::from_word(best as u32))
}

/// Children of a node that a ray enters, from the second lane on.
struct PendingQueue<'a> {
    node: &'a Node,
    lanes: u32,
    near: F32x8,
}

impl PendingQueue<'_> {
    /// The nearest, including `first`; the others are left pending, the nearer to be taken earlier.
    #[inline(always)]
    fn nearest(mut self, first: u64, pending: &mut PendingNodes) -> u64 {
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
    fn last(mut self, first: u64, pending: &mut PendingNodes) -> u64 {
        let mut best = first;
        while self.lanes != 0 {
            pending.push(best);
            best = take::<false>(self.node, &mut self.lanes, &self.near);
        }
        best
    }
}

/// Removes the lowest lane from `lanes`: the ray's entry, if it matters, and the child.
#[inline(always)]
fn take<const SORTED: bool>(node: &Node, lanes: &mut u32, near: &F32x8) -> u64 {
    let lane = lanes.trailing_zeros() as usize & 7;
    *lanes &= *lanes - 1;
    entry(if SORTED { near.0[lane] } else { 0.0 }, node.children[lane])
}

/// Entries on the stack; those of unusually deep trees go to the heap.
const INLINE_ENTRIES: usize = 32;
/// Maximum number of entries that a node adds.
const MAX_NODE_ENTRIES: usize = 7;

/// A stack of entries. An entry is the ray's entry into a child (as bits, which order like the numbers, none being negative) above the
/// child's word.
pub(super) struct PendingNodes {
    at_hand: [u64; INLINE_ENTRIES],
    count: usize,
    deep: Vec<u64>,
}

impl Default for PendingNodes {
    #[inline(always)]
    fn default() -> Self {
        Self { at_hand: [0; INLINE_ENTRIES], count: 0, deep: Vec::new() }
    }
}

/// The entry of a child that the ray enters at `near`.
#[inline(always)]
pub(super) fn entry(near: f32, child: Child) -> u64 {
    u64::from(near.to_bits()) << 32 | u64::from(child.word())
}

impl PendingNodes {
    /// Reserves space for a node's entries.
    #[inline(always)]
    pub(super) fn reserve(&mut self) {
        if self.count > INLINE_ENTRIES - MAX_NODE_ENTRIES {
            self.deepen();
        }
    }

    #[cold]
    #[inline(never)]
    fn deepen(&mut self) {
        self.deep.extend_from_slice(&self.at_hand[..self.count]);
        self.count = 0;
    }

    /// Adds an entry, for which there is space.
    #[inline(always)]
    pub(super) fn push(&mut self, entry: u64) {
        self.at_hand[self.count % INLINE_ENTRIES] = entry;
        self.count += 1;
    }

    /// Sorts the entries added last, at most seven, by insertion: the nearest will be taken first.
    #[inline(always)]
    pub(super) fn sort_last(&mut self, count: usize) {
        let entries = &mut self.at_hand[self.count - count..self.count];
        for end in 1..entries.len() {
            let mut at = end;
            while at > 0 && entries[at - 1] < entries[at] {
                entries.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    /// Takes entries, the last first, until one begins at or before `limit`.
    #[inline(always)]
    pub(super) fn pop(&mut self, limit: f32) -> Option<Child> {
        loop {
            let entry = if self.count > 0 {
                self.count -= 1;
                self.at_hand[self.count % INLINE_ENTRIES]
            } else {
                self.deep.pop()?
            };
            if f32::from_bits((entry >> 32) as u32) <= limit {
                return Some(Child::from_word(entry as u32));
            }
        }
    }
}
