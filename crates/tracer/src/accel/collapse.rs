//! Conversion of binary trees to eight-wide ones, at the least expected cost of a ray.
//!
//! For every binary node and every number of slots from one to seven, the cheapest use of that many slots of a wide node is computed from the leaves
//! upwards. The wide tree is then written from the root (Ylitie, Karras, Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed
//! wide BVHs", section 3). The cost of a node is the area of its box, that of a leaf somewhat more, whatever the number of its primitives: they are
//! tested at once.

use core::cmp::Reverse;

use super::boxes::{BinaryKind, BinaryNode};
use super::node::{Child, Node};

/// Cost of testing a leaf's primitives relative to that of testing a node's boxes: the best of 1, 1.3, 2 and 3.
const LEAF_COST: f32 = 1.3;

/// The nodes of an eight-wide tree.
#[derive(Clone, Debug)]
pub(super) struct WideTree {
    pub(super) nodes: Vec<Node>,
    /// The root node; `None` for an empty tree.
    pub(super) root: Option<Child>,
}

/// Converts a binary tree to an eight-wide one, with at most `leaf_size` primitives per leaf. `place` receives the primitives of each leaf,
/// in ascending order and each once, and returns the index by which its node names it.
pub(super) fn collapse(binary: &[BinaryNode], leaf_size: usize, place: impl FnMut(&[u32]) -> usize) -> WideTree {
    if binary.is_empty() {
        return WideTree { nodes: Vec::new(), root: None };
    }
    let plans = plan(binary, leaf_size as u32);
    let mut writer = WideTreeWriter {
        binary,
        plans: &plans,
        nodes: Vec::with_capacity(binary.len() / 56 + 1),
        place,
        primitives: Vec::new(),
    };
    let root = Some(writer.write());
    let mut nodes = writer.nodes;
    nodes.shrink_to_fit();
    WideTree { nodes, root }
}

/// The best use of one to seven slots by a binary node, and of the eight of its own wide node, in 32 bits.
#[derive(Clone, Copy, Debug)]
struct SlotPlan(u32);

/// Use of one or more slots.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SlotUse {
    /// One slot, a leaf.
    Leaf,
    /// One slot, a wide node.
    Wide,
    /// This many for the first child, the rest for the second.
    Split(u8),
    /// It is cheaper to leave one empty.
    Fewer,
}

impl SlotPlan {
    /// A leaf, for any number of slots.
    const LEAF: Self = Self(1);

    /// A leaf or a wide node in one slot; in two to eight slots the number for the first child, 0 if it is cheaper to leave one empty.
    #[inline(always)]
    fn new(is_leaf: bool, first: [u8; 7]) -> Self {
        let word = first.iter().rev().fold(0, |word, slots| word << 3 | u32::from(*slots));
        Self(word << 1 | u32::from(is_leaf))
    }

    #[inline(always)]
    fn slots(self, slots: u8) -> SlotUse {
        match (slots, self.0 & 1 == 1) {
            (1, true) => SlotUse::Leaf,
            (1, false) => SlotUse::Wide,
            _ => match self.first(slots) {
                0 => SlotUse::Fewer,
                first => SlotUse::Split(first),
            },
        }
    }

    /// Slots for the first child, from two to eight.
    #[inline(always)]
    fn first(self, slots: u8) -> u8 {
        (self.0 >> (3 * slots - 5) & 7) as u8
    }
}

/// Cost of a binary node.
#[derive(Clone, Copy, Debug)]
struct NodeCost {
    /// By number of slots, minus one.
    slots: [f32; 7],
    /// Primitives below, capped.
    primitives: u32,
}

/// Plans of a tree, from its last nodes to the first. The subtrees of a pair of children follow it, that of the first before that of the
/// second: so the costs that are still needed form a stack.
fn plan(binary: &[BinaryNode], leaf_size: u32) -> Vec<SlotPlan> {
    let mut plans = vec![SlotPlan::LEAF; binary.len()];
    let mut pending: Vec<[NodeCost; 2]> = Vec::with_capacity(128);
    for first in (1..binary.len()).step_by(2).rev() {
        let children = [first, first + 1].map(|node| {
            let (plan, cost) = plan_node(&binary[node], leaf_size, &mut pending);
            plans[node] = plan;
            cost
        });
        pending.push(children);
    }
    plans[0] = plan_node(&binary[0], leaf_size, &mut pending).0;
    plans
}

#[inline(always)]
fn plan_node(node: &BinaryNode, leaf_size: u32, pending: &mut Vec<[NodeCost; 2]>) -> (SlotPlan, NodeCost) {
    let area = node.bounds.half_area();
    match node.kind() {
        BinaryKind::Leaf(_) => (SlotPlan::LEAF, NodeCost { slots: [area * LEAF_COST; 7], primitives: 1 }),
        BinaryKind::Inner(_) => plan_inner(area, &pending.pop().expect("children are planned first"), leaf_size),
    }
}

fn plan_inner(area: f32, children: &[NodeCost; 2], leaf_size: u32) -> (SlotPlan, NodeCost) {
    let primitives = children[0].primitives.saturating_add(children[1].primitives);
    let (below, as_wide) = best_split(children, 8);
    let wide = area + below;
    let leaf = if primitives <= leaf_size { area * LEAF_COST } else { f32::INFINITY };
    let mut cost = NodeCost { slots: [wide.min(leaf); 7], primitives };
    let mut first = [0; 7];
    first[6] = as_wide;
    for slots in 2..=7 {
        let (split, first_slots) = best_split(children, slots);
        let fewer = cost.slots[slots - 2];
        cost.slots[slots - 1] = split.min(fewer);
        first[slots - 2] = if split < fewer { first_slots } else { 0 };
    }
    (SlotPlan::new(leaf <= wide, first), cost)
}

/// The minimum cost of two children that share `slots`, and the number for the first.
#[inline(always)]
fn best_split(children: &[NodeCost; 2], slots: usize) -> (f32, u8) {
    let mut best = (f32::INFINITY, 1);
    for first in 1..slots {
        let cost = children[0].slots[first - 1] + children[1].slots[slots - first - 1];
        if cost < best.0 {
            best = (cost, first as u8);
        }
    }
    best
}

/// A binary node and all below it.
#[derive(Clone, Copy, Debug)]
struct Subtree {
    root: u32,
    /// End of the binary nodes below it.
    end: u32,
}

struct WideTreeWriter<'a, F> {
    binary: &'a [BinaryNode],
    plans: &'a [SlotPlan],
    nodes: Vec<Node>,
    place: F,
    /// Primitives of the current leaf.
    primitives: Vec<u32>,
}

impl<F: FnMut(&[u32]) -> usize> WideTreeWriter<'_, F> {
    /// Writes the tree, parents before children and related nodes close together; returns its root.
    fn write(&mut self) -> Child {
        let all_nodes = Subtree { root: 0, end: self.binary.len() as u32 };
        let root = self.child(all_nodes.root);
        let mut pending: Vec<_> = root.as_node().map(|node| (all_nodes, node)).into_iter().collect();
        let mut slots = Vec::with_capacity(8);
        while let Some((subtree, node)) = pending.pop() {
            slots.clear();
            self.spread_wide(subtree, &mut slots);
            // Queries for any hit visit the last slots first: leaves, then nodes with few of them, which are decided soonest.
            slots.sort_by_key(|subtree| Reverse(self.size(*subtree)));
            for (slot, subtree) in slots.iter().enumerate() {
                let child = self.child(subtree.root);
                self.nodes[node].set(slot, &self.binary[subtree.root as usize].bounds, child);
                pending.extend(child.as_node().map(|node| (*subtree, node)));
            }
        }
        root
    }

    /// Reserves a place for a binary node that takes one slot.
    fn child(&mut self, binary: u32) -> Child {
        if self.plans[binary as usize].slots(1) == SlotUse::Leaf {
            self.gather(binary);
            Child::leaf((self.place)(&self.primitives))
        } else {
            if self.nodes.len() == self.nodes.capacity() {
                self.nodes.reserve_exact(self.binary.len() / 224 + 1);
            }
            self.nodes.push(Node::EMPTY);
            Child::node(self.nodes.len() - 1)
        }
    }

    /// Binary nodes below the root of a subtree.
    fn size(&self, Subtree { root, end }: Subtree) -> u32 {
        match self.binary[root as usize].kind() {
            BinaryKind::Inner(first) => end - first,
            BinaryKind::Leaf(_) => 0,
        }
    }

    /// The two halves of a subtree whose root's children are `first` and the next.
    fn halves(&self, first: u32, end: u32) -> [Subtree; 2] {
        let middle = match self.binary[first as usize + 1].kind() {
            BinaryKind::Inner(below) => below,
            BinaryKind::Leaf(_) => end,
        };
        [Subtree { root: first, end: middle }, Subtree { root: first + 1, end }]
    }

    fn spread_wide(&self, subtree: Subtree, out: &mut Vec<Subtree>) {
        if let BinaryKind::Inner(first) = self.binary[subtree.root as usize].kind() {
            let first_slots = self.plans[subtree.root as usize].first(8);
            let [a, b] = self.halves(first, subtree.end);
            self.spread(a, first_slots, out);
            self.spread(b, 8 - first_slots, out);
        }
    }

    /// The contents of the slots of a subtree. At most seven calls deep.
    fn spread(&self, subtree: Subtree, slots: u8, out: &mut Vec<Subtree>) {
        let root = subtree.root as usize;
        match (self.plans[root].slots(slots), self.binary[root].kind()) {
            (_, BinaryKind::Leaf(_)) => out.push(subtree),
            (SlotUse::Fewer, _) => self.spread(subtree, slots - 1, out),
            (SlotUse::Split(first_slots), BinaryKind::Inner(first)) => {
                let [a, b] = self.halves(first, subtree.end);
                self.spread(a, first_slots, out);
                self.spread(b, slots - first_slots, out);
            }
            _ => out.push(subtree),
        }
    }

    /// Collects the primitives below a binary node, in ascending order, each once.
    fn gather(&mut self, binary: u32) {
        self.primitives.clear();
        self.add_below(binary);
        self.primitives.sort_unstable();
        self.primitives.dedup();
    }

    /// Recursion at most as deep as a leaf has primitives.
    fn add_below(&mut self, binary: u32) {
        match self.binary[binary as usize].kind() {
            BinaryKind::Leaf(primitive) => self.primitives.push(primitive),
            BinaryKind::Inner(first) => {
                self.add_below(first);
                self.add_below(first + 1);
            }
        }
    }
}
