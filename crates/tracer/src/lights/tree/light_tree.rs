//! The tree itself: nodes, where what hangs, and what a node's children count for a receiver.

use super::node::{GlossyWeights, LANES, Lanes, Node};
use crate::lights::light_sample::LampIrradiance;
use crate::lights::{LightSampleContext, ReceiverGloss};

/// Where a light or a node hangs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Slot {
    pub(super) node: u32,
    pub(super) lane: u8,
}

/// A tree over lights that are numbered from 0.
#[derive(Clone, Debug)]
pub(in crate::lights) struct LightTree {
    /// The root first.
    pub(super) nodes: Vec<Node>,
    /// Where each node hangs; of no meaning for the root.
    pub(super) parents: Vec<Slot>,
    /// Where each light hangs.
    pub(super) leaves: Vec<Slot>,
    /// Irradiance, W·m⁻²·nm⁻¹, of a weight of 1: weights are told in units of the strongest light, to fit into f32.
    pub(super) scale: f64,
    pub(super) per_irradiance: f32,
}

/// A receiver with what leaves are asked for: the irradiance that a lamp gives it, W·m⁻²·nm⁻¹, raised by its gloss, and without.
pub(in crate::lights) struct TreeQuery<'a, F: Fn(u32) -> LampIrradiance> {
    pub(in crate::lights) receiver: &'a LightSampleContext,
    pub(in crate::lights) lamp: F,
}

/// Share of a cluster's estimate that a lamp with an opening counts at least, whatever its profile is worth from its middle.
const LEAST_OF_EXTENT: f32 = 0.05;

/// What share of a glossy receiver's draws goes by what lights count for a matt one. A lamp that is mirrored may count 10⁴ times and more
/// beside the others; where it is hidden, these are left with this share.
pub(in crate::lights) const MATT_SHARE: f32 = 0.2;

/// What a lamp counts that is worth `own` from its middle and is estimated as a cluster of one to be worth `weight`: parts of an opening
/// may light what its middle does not.
#[inline(always)]
fn of_leaf(node: &Node, lane: usize, own: f32, weight: f32) -> f32 {
    if node.has_extent(lane) { own.max(LEAST_OF_EXTENT * weight) } else { own }
}

impl LightTree {
    /// How many lights there are.
    pub(in crate::lights) fn len(&self) -> usize {
        self.leaves.len()
    }

    /// What a node's children count for a matt receiver.
    pub(super) fn weights<F: Fn(u32) -> LampIrradiance>(&self, node: u32, question: &TreeQuery<'_, F>) -> Lanes {
        let node = &self.nodes[node as usize];
        let mut weights = node.weights(question.receiver);
        for (lane, weight) in weights.iter_mut().enumerate() {
            if node.is_lamp(lane) && *weight > 0.0 {
                let own = (question.lamp)(node.child(lane).index).plain * self.per_irradiance;
                *weight = of_leaf(node, lane, own, *weight);
            }
        }
        weights
    }

    /// What a node's children count for a glossy receiver, and for a matt one in its place.
    pub(super) fn glossy_weights<F: Fn(u32) -> LampIrradiance>(
        &self,
        node: u32,
        question: &TreeQuery<'_, F>,
        gloss: &ReceiverGloss,
    ) -> GlossyWeights {
        let node = &self.nodes[node as usize];
        let mut weights = node.glossy_weights(question.receiver, gloss);
        for lane in 0..LANES {
            if node.is_lamp(lane) && weights.plain[lane] > 0.0 {
                let lamp = (question.lamp)(node.child(lane).index);
                let of = |own: f32, weight: f32| of_leaf(node, lane, own * self.per_irradiance, weight);
                weights.plain[lane] = of(lamp.plain, weights.plain[lane]);
                weights.raised[lane] = of(lamp.raised, weights.raised[lane]);
            }
        }
        weights
    }

    /// What a node's children count for a receiver.
    pub(super) fn raised_weights<F: Fn(u32) -> LampIrradiance>(&self, node: u32, question: &TreeQuery<'_, F>) -> Lanes {
        match &question.receiver.gloss {
            None => self.weights(node, question),
            Some(gloss) => self.glossy_weights(node, question, gloss).raised,
        }
    }

    /// By what a node's children share the draws that come to it.
    pub(super) fn shares<F: Fn(u32) -> LampIrradiance>(&self, node: u32, question: &TreeQuery<'_, F>) -> Lanes {
        match &question.receiver.gloss {
            None => self.weights(node, question),
            Some(gloss) => {
                let GlossyWeights { mut raised, plain, .. } = self.glossy_weights(node, question, gloss);
                mix(&mut raised, &plain);
                raised
            }
        }
    }
}

/// Makes shares of a row of weights: [`MATT_SHARE`] by what lights count for a matt receiver, the rest by what they count raised. Returns
/// the sum of the raised ones.
#[inline(always)]
pub(super) fn mix(raised: &mut [f32], plain: &[f32]) -> f32 {
    let (total, plain_total) = (raised.iter().sum::<f32>(), plain.iter().sum::<f32>());
    // Below, quotients would not be finite; then there is no share for the matt part.
    if total >= f32::MIN_POSITIVE && plain_total >= f32::MIN_POSITIVE {
        let (per_total, per_plain) = ((1.0 - MATT_SHARE) / total, MATT_SHARE / plain_total);
        for (raised, plain) in raised.iter_mut().zip(plain) {
            *raised = *raised * per_total + plain * per_plain;
        }
    }
    total
}
