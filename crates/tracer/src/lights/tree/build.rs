//! Construction of the tree: surface area and orientation heuristic (Conty Estevez and Kulla 2018), eight children per node.
//!
//! The lights of a node are halved repeatedly, always the part of the highest cost, by the best of the planes between twelve bins along each axis,
//! until there are eight parts. Each part of several lights becomes a node. Lights that no plane separates (coincident ones), and those at deep
//! levels, are halved by count, so that the tree is never deeper than [`MAX_SAH_DEPTH`] + log₂ n.

use core::ops::Range;

use super::bounds::LightBounds;
use super::light_tree::{LightTree, ParentSlot};
use super::node::{LANES, LightChild, LightNode};

/// Bins along an axis.
const BINS: usize = 12;

/// Levels beyond which lights are halved by count.
const MAX_SAH_DEPTH: u32 = 24;

/// A light with its bounds.
type Item = (LightBounds, u32);

struct LightTreeBuilder {
    items: Vec<Item>,
    nodes: Vec<LightNode>,
    parents: Vec<ParentSlot>,
    leaves: Vec<ParentSlot>,
    per_scale: f64,
}

impl LightTree {
    /// Builds a tree over lights; `None` if none of them emits.
    pub(in crate::lights) fn new(lights: &[LightBounds]) -> Option<Self> {
        tree(lights)
    }
}

fn tree(lights: &[LightBounds]) -> Option<LightTree> {
    let scale = lights.iter().map(|l| l.intensity).fold(0.0, f64::max);
    if scale <= 0.0 {
        return None;
    }
    let items: Vec<Item> = lights.iter().copied().zip(0..).collect();
    let leaves = vec![ParentSlot::default(); items.len()];
    let mut builder = LightTreeBuilder { items, nodes: vec![], parents: vec![], leaves, per_scale: 1.0 / scale };
    builder.node(0..lights.len(), ParentSlot::default(), 0);
    let LightTreeBuilder { nodes, parents, leaves, .. } = builder;
    Some(LightTree { nodes, parents, leaves, scale, per_irradiance: (1.0 / scale) as f32 })
}

/// A contiguous range of lights in the list.
struct LightRange {
    range: Range<usize>,
    bounds: LightBounds,
}

impl LightTreeBuilder {
    fn node(&mut self, range: Range<usize>, parent: ParentSlot, level: u32) -> u32 {
        let parts = self.parts(range, level);
        let index = self.nodes.len() as u32;
        self.nodes.push(LightNode::default());
        self.parents.push(parent);
        for (lane, part) in parts.into_iter().enumerate() {
            let slot = ParentSlot { node: index, lane: lane as u8 };
            let child = self.child(part.range, slot, level + 1);
            self.nodes[index as usize].set(lane, &part.bounds, child, self.per_scale);
        }
        index
    }

    fn child(&mut self, range: Range<usize>, slot: ParentSlot, level: u32) -> LightChild {
        if range.len() > 1 {
            return LightChild { index: self.node(range, slot, level), is_node: true };
        }
        let light = self.items[range.start].1;
        self.leaves[light as usize] = slot;
        LightChild { index: light, is_node: false }
    }

    /// Up to eight parts of a range.
    fn parts(&mut self, range: Range<usize>, level: u32) -> Vec<LightRange> {
        if range.len() <= LANES {
            return range.map(|i| self.part(i..i + 1)).collect();
        }
        let mut parts = vec![self.part(range)];
        while parts.len() < LANES {
            let dearest = (0..parts.len()).filter(|i| parts[*i].range.len() > 1).max_by(|a, b| {
                let order = parts[*a].bounds.cost().total_cmp(&parts[*b].bounds.cost());
                order.then(parts[*a].range.len().cmp(&parts[*b].range.len()))
            });
            let Some(dearest) = dearest else { break };
            let part = parts.swap_remove(dearest);
            let middle = self.halve(&part, level);
            parts.push(self.part(part.range.start..middle));
            parts.push(self.part(middle..part.range.end));
        }
        parts
    }

    fn part(&self, range: Range<usize>) -> LightRange {
        let first = self.items[range.start].0;
        let bounds = self.items[range.clone()].iter().skip(1).fold(first, |b, (other, _)| b.union(other));
        LightRange { range, bounds }
    }

    /// Sorts the lights of a part so that those before the returned index are one half.
    fn halve(&mut self, part: &LightRange, level: u32) -> usize {
        let items = &mut self.items[part.range.clone()];
        let half = items.len() / 2;
        let before = match best_plane(items, part).filter(|_| level < MAX_SAH_DEPTH) {
            Some((axis, at)) => partition(items, |item| item.0.centre()[axis] < at),
            None => {
                let extent = part.bounds.high - part.bounds.low;
                let axis = extent.max_position();
                items.select_nth_unstable_by(half, |a, b| {
                    a.0.centre()[axis].total_cmp(&b.0.centre()[axis]).then(a.1.cmp(&b.1))
                });
                half
            }
        };
        part.range.start + if before == 0 || before == part.range.len() { half } else { before }
    }
}

/// The axis and plane of minimum cost; `None` if all middles coincide.
fn best_plane(items: &[Item], part: &LightRange) -> Option<(usize, f32)> {
    let (mut low, mut high) = (items[0].0.centre(), items[0].0.centre());
    for (bounds, _) in items {
        (low, high) = (low.min(bounds.centre()), high.max(bounds.centre()));
    }
    let extent = high - low;
    let longest = (part.bounds.high - part.bounds.low).max_element();
    let mut best: Option<(f64, usize, f32)> = None;
    for axis in (0..3).filter(|axis| extent[*axis] > 0.0) {
        // Long boxes are cut across.
        let regular = f64::from(longest / (part.bounds.high - part.bounds.low)[axis].max(f32::MIN_POSITIVE));
        let bins = binned(items, axis, low[axis], extent[axis]);
        for (cut, cost) in cut_costs(&bins) {
            let cost = cost * regular;
            if cost.is_finite() && best.is_none_or(|b| cost < b.0) {
                best = Some((cost, axis, low[axis] + extent[axis] * (cut as f32 / BINS as f32)));
            }
        }
    }
    best.map(|(_, axis, at)| (axis, at))
}

fn binned(items: &[Item], axis: usize, low: f32, extent: f32) -> [Option<LightBounds>; BINS] {
    let mut bins = [None; BINS];
    for (bounds, _) in items {
        let bin = ((bounds.centre()[axis] - low) / extent * BINS as f32) as usize;
        let bin = &mut bins[bin.min(BINS - 1)];
        *bin = join(*bin, Some(*bounds));
    }
    bins
}

fn join(a: Option<LightBounds>, b: Option<LightBounds>) -> Option<LightBounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (one, other) => one.or(other),
    }
}

/// Cost of each cut between bins, except cuts that leave one side empty.
fn cut_costs(bins: &[Option<LightBounds>; BINS]) -> impl Iterator<Item = (usize, f64)> {
    let mut above = [None; BINS];
    let mut sum = None;
    for i in (1..BINS).rev() {
        sum = join(bins[i], sum);
        above[i] = sum;
    }
    let mut below = None;
    let bins = *bins;
    (1..BINS).filter_map(move |cut| {
        below = join(below, bins[cut - 1]);
        Some((cut, below.as_ref()?.cost() + above[cut].as_ref()?.cost()))
    })
}

/// Moves items that fulfil `first` before those that do not; returns their number.
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let mut before = 0;
    for i in 0..items.len() {
        if first(&items[i]) {
            items.swap(before, i);
            before += 1;
        }
    }
    before
}
