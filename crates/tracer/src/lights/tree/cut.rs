//! The cut of the tree that a receiver chooses from.
//!
//! Clusters are opened before anything is chosen, from the root on, until [`OPENED`] nodes are open; of what is left one is drawn. (Conty
//! Estevez and Kulla 2018 open clusters that are near in the same manner, and sample each.) Opened are:
//!
//! - For a glossy receiver, as the mean of a narrow lobe over a cluster tells nothing of the one lamp in it that is mirrored: those that would
//!   count more than [`MATTERS`] of the whole estimate if all their light came from that place in them which the lobes favour most.
//! - For a matt receiver in view, as the estimate of a cluster that it stands in or near is rough: those that count more than
//!   [`MATTERS_TO_MATT`]. Elsewhere on a path this does not pay for its time.

use super::falling::{draw, share};
use super::light_tree::{LightTree, Slot, TreeQuery, mix};
use super::node::{GlossyWeights, LANES, Node};
use crate::lights::ReceiverGloss;
use crate::lights::light_sample::LampIrradiance;

/// Nodes opened at most.
const OPENED: usize = 16;

/// Share of the whole estimate, as the root's children make it, above which a cluster's greatest estimate has it opened. Between 0.1
/// and 0.5 the error of the wet street changes by a hundredth, and its time by a twentieth.
const MATTERS: f32 = 0.3;

/// The same for a matt receiver, of what a cluster counts. With 0.1 the street at night gains 1.8 instead of 2.0 times, wet 1.05 instead of 1.10 times.
const MATTERS_TO_MATT: f32 = 0.02;

/// Lights and clusters of all that a receiver chooses from, by their slots.
pub(in crate::lights) struct Cut {
    /// Node × [`LANES`] + lane.
    slots: [u32; OPENED * LANES],
    /// What each counts raised by the gloss; in the end by what they share the draws.
    shares: [f32; OPENED * LANES],
    /// What each counts for a matt receiver.
    plain: [f32; OPENED * LANES],
    len: usize,
    /// Sum of what they count.
    total: f32,
}

impl LightTree {
    /// The cut of a glossy receiver.
    #[inline(always)]
    pub(super) fn glossy_cut<F: Fn(u32) -> LampIrradiance>(
        &self,
        question: &TreeQuery<'_, F>,
        gloss: &ReceiverGloss,
    ) -> Cut {
        let greatest =
            |node: &Node, lane: usize, weights: &GlossyWeights| node.greatest(lane, weights, question.receiver, gloss);
        let mut cut = self.cut(MATTERS, |node| self.glossy_weights(node, question, gloss), greatest);
        cut.total = mix(&mut cut.shares[..cut.len], &cut.plain[..cut.len]);
        cut
    }

    /// The cut of a matt receiver.
    #[inline(always)]
    pub(super) fn matt_cut<F: Fn(u32) -> LampIrradiance>(&self, question: &TreeQuery<'_, F>) -> Cut {
        let weigh = |node| {
            let plain = self.weights(node, question);
            GlossyWeights { raised: plain, plain, faced: plain }
        };
        let mut cut = self.cut(MATTERS_TO_MATT, weigh, |_, lane, weights| weights.plain[lane]);
        cut.total = cut.shares[..cut.len].iter().sum();
        cut
    }

    /// Opens clusters whose `greatest` count exceeds a share of the whole; the total is not yet known.
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

    /// Sum of what all count, raised by the gloss.
    pub(super) fn total(&self) -> f32 {
        self.total
    }

    /// The slot that `u` in [0, 1) falls on, its probability, and where in it `u` lies; `None` where nothing counts.
    pub(super) fn draw(&self, u: f64) -> Option<(Slot, f32, f64)> {
        let (i, share, within) = draw(&self.shares[..self.len], u)?;
        Some((slot_of(self.slots[i]), share, within))
    }

    /// The probability of a slot; `None` where it is no part of the cut.
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
