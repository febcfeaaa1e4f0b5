//! Binary trees to eight-wide ones, at the least expected cost of a ray.
//!
//! For every binary node and every number of slots from one to seven, the cheapest way to stand in that many slots of a
//! wide node is found from the leaves upwards; the wide tree is then read off from the root (Ylitie, Karras, Laine 2017,
//! "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", section 3). The cost of a node is the
//! area of its box, that of a leaf somewhat more, whatever the number of its primitives: they are tested at once.

use super::binary::{BinaryKind, BinaryNode};
use super::node::{Child, Node};

/// Cost of testing a leaf's primitives relative to that of testing a node's boxes: the best of 1, 1.3, 2 and 3.
const LEAF_COST: f32 = 1.3;

/// An eight-wide tree.
#[derive(Clone, Debug)]
pub(super) struct Wide {
    pub(super) nodes: Vec<Node>,
    /// Where rays begin; `None` for an empty tree.
    pub(super) root: Option<Child>,
    /// The primitives of each leaf, at most as many as asked for.
    pub(super) leaves: Vec<Vec<u32>>,
}

/// Makes a binary tree (node 0 its root) eight wide, with at most `leaf_size` primitives a leaf.
pub(super) fn collapse(binary: &[BinaryNode], leaf_size: usize) -> Wide {
    let mut wide = Wide { nodes: Vec::new(), root: None, leaves: Vec::new() };
    if binary.is_empty() {
        return wide;
    }
    let plans = plan(binary, leaf_size as u32);
    let child = Writer { binary, plans: &plans, wide: &mut wide }.write();
    wide.root = Some(child);
    wide
}

/// How a binary node best stands in one to seven slots.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// Cost by number of slots, less one.
    cost: [f32; 7],
    /// How the slots are used, by their number, less one.
    slots: [Slots; 7],
    /// Slots for the first child where the node becomes a wide one with eight.
    as_wide: u8,
    /// Primitives below, capped.
    primitives: u32,
}

/// What to do with some slots.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slots {
    /// One slot, a leaf.
    Leaf,
    /// One slot, a wide node.
    Wide,
    /// As many for the first child, the rest for the second.
    Split(u8),
    /// One is better left empty.
    Fewer,
}

fn plan(binary: &[BinaryNode], leaf_size: u32) -> Vec<Plan> {
    let leaf = Plan { cost: [0.0; 7], slots: [Slots::Fewer; 7], as_wide: 0, primitives: 1 };
    let mut plans = vec![leaf; binary.len()];
    for node in parents_first(binary).into_iter().rev() {
        let BinaryNode { bounds, kind } = binary[node as usize];
        plans[node as usize] = match kind {
            BinaryKind::Leaf(_) => plan_leaf(bounds.half_area()),
            BinaryKind::Inner(first) => {
                let children = [plans[first as usize], plans[first as usize + 1]];
                plan_inner(bounds.half_area(), &children, leaf_size)
            }
        };
    }
    plans
}

fn parents_first(binary: &[BinaryNode]) -> Vec<u32> {
    let mut order = Vec::with_capacity(binary.len());
    let mut pending = vec![0];
    while let Some(node) = pending.pop() {
        order.push(node);
        if let BinaryKind::Inner(first) = binary[node as usize].kind {
            pending.extend([first + 1, first]);
        }
    }
    order
}

fn plan_leaf(area: f32) -> Plan {
    let mut slots = [Slots::Fewer; 7];
    slots[0] = Slots::Leaf;
    Plan { cost: [area * LEAF_COST; 7], slots, as_wide: 0, primitives: 1 }
}

fn plan_inner(area: f32, children: &[Plan; 2], leaf_size: u32) -> Plan {
    let primitives = children[0].primitives.saturating_add(children[1].primitives);
    let (below, as_wide) = best_split(children, 8);
    let wide = area + below;
    let leaf = if primitives <= leaf_size { area * LEAF_COST } else { f32::INFINITY };
    let mut plan = Plan { cost: [wide.min(leaf); 7], slots: [Slots::Fewer; 7], as_wide, primitives };
    plan.slots[0] = if leaf <= wide { Slots::Leaf } else { Slots::Wide };
    for slots in 2..=7 {
        let (cost, first) = best_split(children, slots);
        let fewer = plan.cost[slots - 2];
        plan.cost[slots - 1] = cost.min(fewer);
        plan.slots[slots - 1] = if cost < fewer { Slots::Split(first) } else { Slots::Fewer };
    }
    plan
}

/// The least cost of two children that share `slots`, and how many the first gets.
fn best_split(children: &[Plan; 2], slots: usize) -> (f32, u8) {
    let mut best = (f32::INFINITY, 1);
    for first in 1..slots {
        let cost = children[0].cost[first - 1] + children[1].cost[slots - first - 1];
        if cost < best.0 {
            best = (cost, first as u8);
        }
    }
    best
}

struct Writer<'a> {
    binary: &'a [BinaryNode],
    plans: &'a [Plan],
    wide: &'a mut Wide,
}

impl Writer<'_> {
    /// Writes the tree, parents before children and near relatives near each other; returns its root.
    fn write(mut self) -> Child {
        let root = self.child(0);
        let mut pending: Vec<_> = root.as_node().map(|node| (0, node)).into_iter().collect();
        while let Some((binary, node)) = pending.pop() {
            let mut slots = Vec::with_capacity(8);
            self.spread_wide(binary, &mut slots);
            // Rays that ask for any hit take the last slots first: large boxes are likely to stop them.
            slots.sort_by(|a, b| self.area(*a).total_cmp(&self.area(*b)));
            for (slot, binary) in slots.into_iter().enumerate() {
                let child = self.child(binary);
                self.wide.nodes[node].set(slot, &self.binary[binary as usize].bounds, child);
                pending.extend(child.as_node().map(|node| (binary, node)));
            }
        }
        root
    }

    /// Makes room for a binary node that stands in one slot.
    fn child(&mut self, binary: u32) -> Child {
        if self.plans[binary as usize].slots[0] == Slots::Leaf {
            let primitives = self.primitives(binary);
            self.wide.leaves.push(primitives);
            Child::leaf(self.wide.leaves.len() - 1)
        } else {
            self.wide.nodes.push(Node::EMPTY);
            Child::node(self.wide.nodes.len() - 1)
        }
    }

    fn area(&self, binary: u32) -> f32 {
        self.binary[binary as usize].bounds.half_area()
    }

    fn spread_wide(&self, binary: u32, out: &mut Vec<u32>) {
        if let BinaryKind::Inner(first) = self.binary[binary as usize].kind {
            let share = self.plans[binary as usize].as_wide;
            self.spread(first, share, out);
            self.spread(first + 1, 8 - share, out);
        }
    }

    /// The binary nodes that stand in the slots given to `binary`. At most seven calls deep.
    fn spread(&self, binary: u32, slots: u8, out: &mut Vec<u32>) {
        match (self.plans[binary as usize].slots[usize::from(slots) - 1], self.binary[binary as usize].kind) {
            (Slots::Fewer, _) => self.spread(binary, slots - 1, out),
            (Slots::Split(share), BinaryKind::Inner(first)) => {
                self.spread(first, share, out);
                self.spread(first + 1, slots - share, out);
            }
            _ => out.push(binary),
        }
    }

    /// The primitives below a binary node, in ascending order, each once.
    fn primitives(&self, binary: u32) -> Vec<u32> {
        let mut primitives = Vec::with_capacity(8);
        let mut pending = vec![binary];
        while let Some(node) = pending.pop() {
            match self.binary[node as usize].kind {
                BinaryKind::Leaf(primitive) => primitives.push(primitive),
                BinaryKind::Inner(first) => pending.extend([first, first + 1]),
            }
        }
        primitives.sort_unstable();
        primitives.dedup();
        primitives
    }
}
