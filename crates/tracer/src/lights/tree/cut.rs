//! The cut of the tree from which a receiver chooses.
//!
//! Clusters are opened before the choice, from the root on, until [`MAX_OPENED_NODES`] nodes are open. One of the resulting slots is sampled. (Conty Estevez
//! and Kulla 2018 open near clusters in the same manner, and sample each.) Opened are:
//!
//! - For a glossy receiver, clusters whose weight would exceed [`GLOSSY_THRESHOLD`] of the whole estimate if all their light came from the place in them
//!   that the lobes favour most. The mean of a narrow lobe over a cluster contains no information on the one lamp in it that is reflected.
//! - For a diffuse receiver in view, clusters whose weight exceeds [`DIFFUSE_THRESHOLD`], as the estimate of a cluster around or near the receiver
//!   is rough. Elsewhere on a path this is not worth its time.

use super::light_tree::{LightTree, ParentSlot, TreeQuery, mix};
use super::node::{GlossyWeights, LANES, LightNode};
use crate::{lights::ReceiverGloss, lights::light_sample::LampIrradiance};

/// Maximum number of opened nodes.
const MAX_OPENED_NODES: usize = 16;

/// Fraction of the whole estimate, as computed from the root's children, above which a cluster's maximum estimate has it opened. Between
/// 0.1 and 0.5 the error of the wet street changes by a hundredth, and its time by a twentieth.
const GLOSSY_THRESHOLD: f32 = 0.3;

/// The same for a diffuse receiver, for a cluster's weight. With 0.1 the street at night gains 1.8 instead of 2.0 times, wet 1.05 instead
/// of 1.10 times.
const DIFFUSE_THRESHOLD: f32 = 0.02;

/// Lights and clusters from which a receiver chooses, by their slots.
pub(in crate::lights) struct LightCut {
    /// Node × [`LANES`] + lane.
    slots: [u32; MAX_OPENED_NODES * LANES],
    /// Weight of each slot raised by the gloss; finally its selection probability.
    weights: [f32; MAX_OPENED_NODES * LANES],
    /// Weight of each slot for a diffuse receiver.
    diffuse: [f32; MAX_OPENED_NODES * LANES],
    len: usize,
    /// Sum of the weights.
    total: f32,
}

impl LightTree {
    /// The cut of a glossy receiver.
    #[inline(always)]
    fn glossy_cut<F: Fn(u32) -> LampIrradiance>(&self, query: &TreeQuery<'_, F>, gloss: &ReceiverGloss) -> LightCut {
        let maximum = |node: &LightNode, lane: usize, weights: &GlossyWeights| {
            node.max_weights(lane, weights, query.receiver, gloss)
        };
        let mut cut = self.cut(GLOSSY_THRESHOLD, |node| self.glossy_weights(node, query, gloss), maximum);
        cut.total = mix(&mut cut.weights[..cut.len], &cut.diffuse[..cut.len]);
        cut
    }

    /// The cut of a diffuse receiver.
    #[inline(always)]
    fn diffuse_cut<F: Fn(u32) -> LampIrradiance>(&self, query: &TreeQuery<'_, F>) -> LightCut {
        let weigh = |node| {
            let plain = self.weights(node, query);
            GlossyWeights { with_gloss: plain, diffuse: plain, facing: plain }
        };
        let mut cut = self.cut(DIFFUSE_THRESHOLD, weigh, |_, lane, weights| weights.diffuse[lane]);
        cut.total = cut.weights[..cut.len].iter().sum();
        cut
    }

    /// Opens clusters whose `greatest` weight exceeds a fraction of the whole; the total is not yet known.
    #[inline(always)]
    fn cut(
        &self,
        threshold: f32,
        weigh: impl Fn(u32) -> GlossyWeights,
        maximum: impl Fn(&LightNode, usize, &GlossyWeights) -> f32,
    ) -> LightCut {
        let mut weights = weigh(0);
        let minimum = threshold * weights.with_gloss.iter().sum::<f32>();
        let mut cut = LightCut::empty();
        let mut open = [0_u32; MAX_OPENED_NODES];
        let (mut next, mut opened) = (0, 1);
        while next < opened {
            let index = open[next];
            let node = &self.nodes[index as usize];
            for (lane, weight) in weights.with_gloss.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
                let child = node.child(lane);
                let opens = child.is_node && opened < MAX_OPENED_NODES;
                if opens && maximum(node, lane, &weights) > minimum {
                    open[opened] = child.index;
                    opened += 1;
                } else {
                    cut.push(slot_code(ParentSlot { node: index, lane: lane as u8 }), weight, weights.diffuse[lane]);
                }
            }
            next += 1;
            if next < opened {
                weights = weigh(open[next]);
            }
        }
        cut
    }
}

impl LightCut {
    fn empty() -> Self {
        const NONE: [f32; MAX_OPENED_NODES * LANES] = [0.0; MAX_OPENED_NODES * LANES];
        Self { slots: [0; MAX_OPENED_NODES * LANES], weights: NONE, diffuse: NONE, len: 0, total: 0.0 }
    }

    fn push(&mut self, slot: u32, raised: f32, plain: f32) {
        self.slots[self.len] = slot;
        self.weights[self.len] = raised;
        self.diffuse[self.len] = plain;
        self.len += 1;
    }

    /// Sum of all weights, raised by the gloss.
    pub(super) fn total(&self) -> f32 {
        self.total
    }

    /// The slot selected by `u` in [0, 1), its probability, and the place of `u` within it; `None` if all weights are zero.
    pub(super) fn sample(&self, u: f64) -> Option<(ParentSlot, f32, f64)> {
        let (i, probability, within) = sample_index(&self.weights[..self.len], u)?;
        Some((slot_of(self.slots[i]), probability, within))
    }

    /// The probability of a slot; `None` if it is no part of the cut.
    pub(super) fn probability(&self, slot: ParentSlot) -> Option<f32> {
        let i = self.slots[..self.len].iter().position(|other| *other == slot_code(slot))?;
        Some(fraction_of_total(&self.weights[..self.len], i))
    }
}

fn slot_code(slot: ParentSlot) -> u32 {
    slot.node * LANES as u32 + u32::from(slot.lane)
}

fn slot_of(code: u32) -> ParentSlot {
    ParentSlot { node: code / LANES as u32, lane: (code % LANES as u32) as u8 }
}

/// The first choice of a receiver.
#[expect(
    clippy::large_enum_variant,
    reason = "lives on the stack for one draw; a box would cost an allocation at each vertex"
)]
pub(in crate::lights) enum TreeStart {
    /// The only light, or none.
    Only,
    /// The root's children, by their weights.
    Root([f32; LANES]),
    /// For a glossy receiver, or one in view: lights and clusters of a cut.
    Cut(LightCut),
}

impl LightTree {
    /// Start of the descent.
    #[inline(always)]
    pub(in crate::lights) fn start<F: Fn(u32) -> LampIrradiance>(&self, query: &TreeQuery<'_, F>) -> TreeStart {
        if self.len() == 1 {
            return TreeStart::Only;
        }
        match &query.receiver.gloss {
            Some(gloss) => TreeStart::Cut(self.glossy_cut(query, gloss)),
            None if query.receiver.in_view => TreeStart::Cut(self.diffuse_cut(query)),
            None => TreeStart::Root(self.weights(0, query)),
        }
    }
}

impl TreeStart {
    /// The slot selected by `u` in [0, 1), its probability, and the place of `u` within it; `None` if all weights are zero.
    pub(super) fn sample(&self, u: f64) -> Option<(ParentSlot, f32, f64)> {
        match self {
            Self::Only => Some((ParentSlot::default(), 1.0, u)),
            Self::Cut(cut) => cut.sample(u),
            Self::Root(weights) => {
                let (lane, probability, within) = sample_index(weights, u)?;
                Some((ParentSlot { node: 0, lane: lane as u8 }, probability, within))
            }
        }
    }

    /// The probability of a slot; `None` if it is not part of the first choice.
    pub(super) fn probability(&self, slot: ParentSlot) -> Option<f32> {
        match self {
            Self::Only => Some(1.0),
            Self::Cut(cut) => cut.probability(slot),
            Self::Root(weights) => (slot.node == 0).then(|| fraction_of_total(weights, usize::from(slot.lane))),
        }
    }
}

/// The fraction of a weight in the sum of its row.
pub(super) fn fraction_of_total(weights: &[f32], index: usize) -> f32 {
    let total: f32 = weights.iter().sum();
    if total > 0.0 { weights[index] / total } else { 0.0 }
}

/// The weight of a row selected by `u` in [0, 1), its fraction, and the place of `u` within it, in [0, 1); `None` if the row has none.
pub(super) fn sample_index(weights: &[f32], u: f64) -> Option<(usize, f32, f64)> {
    // As f64, in which no sum of these loses a weight that the fraction would include: the sum of f32 may differ by some roundings.
    let mut rest = u * weights.iter().map(|weight| f64::from(*weight)).sum::<f64>();
    let mut chosen = None;
    for (index, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        let weight = f64::from(*weight);
        chosen = Some((index, (rest / weight).min(ONE_BELOW)));
        if rest < weight {
            break;
        }
        rest -= weight;
    }
    chosen.map(|(index, within)| (index, fraction_of_total(weights, index), within))
}

/// The largest `f64` below one.
const ONE_BELOW: f64 = 1.0 - 0.5 * f64::EPSILON;
