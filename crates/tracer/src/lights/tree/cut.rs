//! The cut of the tree from which a receiver chooses.
//!
//! Clusters are opened before the choice, from the root on, until [`OPENED`] nodes are open. One of the resulting slots is sampled. (Conty Estevez
//! and Kulla 2018 open near clusters in the same manner, and sample each.) Opened are:
//!
//! - For a glossy receiver, clusters whose weight would exceed [`MATTERS`] of the whole estimate if all their light came from the place in them
//!   that the lobes favour most. The mean of a narrow lobe over a cluster contains no information on the one lamp in it that is reflected.
//! - For a diffuse receiver in view, clusters whose weight exceeds [`MATTERS_TO_MATT`], as the estimate of a cluster around or near the receiver
//!   is rough. Elsewhere on a path this is not worth its time.

use super::light_tree::{LightTree, Slot, TreeQuery, mix};
use super::node::{GlossyWeights, LANES, Node};
use crate::{lights::ReceiverGloss, lights::light_sample::LampIrradiance};

/// Maximum number of opened nodes.
const OPENED: usize = 16;

/// Fraction of the whole estimate, as computed from the root's children, above which a cluster's maximum estimate has it opened. Between
/// 0.1 and 0.5 the error of the wet street changes by a hundredth, and its time by a twentieth.
const MATTERS: f32 = 0.3;

/// The same for a diffuse receiver, for a cluster's weight. With 0.1 the street at night gains 1.8 instead of 2.0 times, wet 1.05 instead
/// of 1.10 times.
const MATTERS_TO_MATT: f32 = 0.02;

/// Lights and clusters from which a receiver chooses, by their slots.
pub(in crate::lights) struct Cut {
    /// Node × [`LANES`] + lane.
    slots: [u32; OPENED * LANES],
    /// Weight of each slot raised by the gloss; finally its selection probability.
    shares: [f32; OPENED * LANES],
    /// Weight of each slot for a diffuse receiver.
    plain: [f32; OPENED * LANES],
    len: usize,
    /// Sum of the weights.
    total: f32,
}

impl LightTree {
    /// The cut of a glossy receiver.
    #[inline(always)]
    fn glossy_cut<F: Fn(u32) -> LampIrradiance>(&self, question: &TreeQuery<'_, F>, gloss: &ReceiverGloss) -> Cut {
        let greatest =
            |node: &Node, lane: usize, weights: &GlossyWeights| node.greatest(lane, weights, question.receiver, gloss);
        let mut cut = self.cut(MATTERS, |node| self.glossy_weights(node, question, gloss), greatest);
        cut.total = mix(&mut cut.shares[..cut.len], &cut.plain[..cut.len]);
        cut
    }

    /// The cut of a diffuse receiver.
    #[inline(always)]
    fn matt_cut<F: Fn(u32) -> LampIrradiance>(&self, question: &TreeQuery<'_, F>) -> Cut {
        let weigh = |node| {
            let plain = self.weights(node, question);
            GlossyWeights { raised: plain, plain, faced: plain }
        };
        let mut cut = self.cut(MATTERS_TO_MATT, weigh, |_, lane, weights| weights.plain[lane]);
        cut.total = cut.shares[..cut.len].iter().sum();
        cut
    }

    /// Opens clusters whose `greatest` weight exceeds a fraction of the whole; the total is not yet known.
    #[inline(always)]
    fn cut(
        &self,
        share: f32,
        weigh: impl Fn(u32) -> GlossyWeights,
        greatest: impl Fn(&Node, usize, &GlossyWeights) -> f32,
    ) -> Cut {
        let mut weights = weigh(0);
        let least = share * weights.raised.iter().sum::<f32>();
        let mut cut = Cut::empty();
        let mut open = [0_u32; OPENED];
        let (mut next, mut opened) = (0, 1);
        while next < opened {
            let index = open[next];
            let node = &self.nodes[index as usize];
            for (lane, weight) in weights.raised.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
                let child = node.child(lane);
                let opens = child.is_node && opened < OPENED;
                if opens && greatest(node, lane, &weights) > least {
                    open[opened] = child.index;
                    opened += 1;
                } else {
                    cut.push(coded(Slot { node: index, lane: lane as u8 }), weight, weights.plain[lane]);
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

impl Cut {
    fn empty() -> Self {
        const NONE: [f32; OPENED * LANES] = [0.0; OPENED * LANES];
        Self { slots: [0; OPENED * LANES], shares: NONE, plain: NONE, len: 0, total: 0.0 }
    }

    fn push(&mut self, slot: u32, raised: f32, plain: f32) {
        self.slots[self.len] = slot;
        self.shares[self.len] = raised;
        self.plain[self.len] = plain;
        self.len += 1;
    }

    /// Sum of all weights, raised by the gloss.
    pub(super) fn total(&self) -> f32 {
        self.total
    }

    /// The slot selected by `u` in [0, 1), its probability, and the place of `u` within it; `None` if all weights are zero.
    pub(super) fn draw(&self, u: f64) -> Option<(Slot, f32, f64)> {
        let (i, share, within) = draw(&self.shares[..self.len], u)?;
        Some((slot_of(self.slots[i]), share, within))
    }

    /// The probability of a slot; `None` if it is no part of the cut.
    pub(super) fn share(&self, slot: Slot) -> Option<f32> {
        let i = self.slots[..self.len].iter().position(|other| *other == coded(slot))?;
        Some(share(&self.shares[..self.len], i))
    }
}

fn coded(slot: Slot) -> u32 {
    slot.node * LANES as u32 + u32::from(slot.lane)
}

fn slot_of(code: u32) -> Slot {
    Slot { node: code / LANES as u32, lane: (code % LANES as u32) as u8 }
}

/// The first choice of a receiver.
#[expect(
    clippy::large_enum_variant,
    reason = "lives on the stack for one draw; a box would cost an allocation at each vertex"
)]
pub(in crate::lights) enum Start {
    /// The only light, or none.
    Only,
    /// The root's children, by their weights.
    Root([f32; LANES]),
    /// For a glossy receiver, or one in view: lights and clusters of a cut.
    Cut(Cut),
}

impl LightTree {
    /// Start of the descent.
    #[inline(always)]
    pub(in crate::lights) fn start<F: Fn(u32) -> LampIrradiance>(&self, question: &TreeQuery<'_, F>) -> Start {
        if self.len() == 1 {
            return Start::Only;
        }
        match &question.receiver.gloss {
            Some(gloss) => Start::Cut(self.glossy_cut(question, gloss)),
            None if question.receiver.in_view => Start::Cut(self.matt_cut(question)),
            None => Start::Root(self.weights(0, question)),
        }
    }
}

impl Start {
    /// The slot selected by `u` in [0, 1), its probability, and the place of `u` within it; `None` if all weights are zero.
    pub(super) fn draw(&self, u: f64) -> Option<(Slot, f32, f64)> {
        match self {
            Self::Only => Some((Slot::default(), 1.0, u)),
            Self::Cut(cut) => cut.draw(u),
            Self::Root(weights) => {
                let (lane, share, within) = draw(weights, u)?;
                Some((Slot { node: 0, lane: lane as u8 }, share, within))
            }
        }
    }

    /// The probability of a slot; `None` if it is not part of the first choice.
    pub(super) fn share(&self, slot: Slot) -> Option<f32> {
        match self {
            Self::Only => Some(1.0),
            Self::Cut(cut) => cut.share(slot),
            Self::Root(weights) => (slot.node == 0).then(|| share(weights, usize::from(slot.lane))),
        }
    }
}

/// The fraction of a weight in the sum of its row.
pub(super) fn share(weights: &[f32], index: usize) -> f32 {
    let total: f32 = weights.iter().sum();
    if total > 0.0 { weights[index] / total } else { 0.0 }
}

/// The weight of a row selected by `u` in [0, 1), its fraction, and the place of `u` within it, in [0, 1); `None` if the row has none.
pub(super) fn draw(weights: &[f32], u: f64) -> Option<(usize, f32, f64)> {
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
    chosen.map(|(index, within)| (index, share(weights, index), within))
}

/// The largest `f64` below one.
const ONE_BELOW: f64 = 1.0 - 0.5 * f64::EPSILON;
