//! The tree itself: nodes, the slots of lights and nodes, and the weights of a node's children for a receiver.

use super::node::{GlossyWeights, LANES, Lanes, Node};
use crate::lights::light_sample::LampIrradiance;
use crate::lights::{LightSampleContext, ReceiverGloss};

/// Place of a light or a node in its parent.
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
    /// Slot of each node; without meaning for the root.
    pub(super) parents: Vec<Slot>,
    /// Slot of each light.
    pub(super) leaves: Vec<Slot>,
    /// Irradiance, W·m⁻²·nm⁻¹, of a weight of 1: weights are in units of the strongest light, to fit into f32.
    pub(super) scale: f64,
    pub(super) per_irradiance: f32,
}

/// A receiver with the function that leaves evaluate: the irradiance of a lamp at the receiver, W·m⁻²·nm⁻¹, raised by its gloss, and
/// without.
pub(in crate::lights) struct TreeQuery<'a, F: Fn(u32) -> LampIrradiance> {
    pub(in crate::lights) receiver: &'a LightSampleContext,
    pub(in crate::lights) lamp: F,
}

/// Minimum weight of a lamp with an opening, as a fraction of its estimate as a cluster, whatever its profile gives from its middle.
const LEAST_OF_EXTENT: f32 = 0.05;

/// Fraction of a glossy receiver's samples that uses the weights of a diffuse one. A reflected lamp may weigh 10⁴ times as much as the
/// others and more; if it is hidden, these are left with this fraction.
pub(in crate::lights) const MATT_SHARE: f32 = 0.2;

/// The weight of a lamp of weight `own` from its middle and estimated weight `weight` as a cluster of one: parts of an opening may light
/// points that its middle does not.
#[inline(always)]
fn of_leaf(node: &Node, lane: usize, own: f32, weight: f32) -> f32 {
    if node.has_extent(lane) { own.max(LEAST_OF_EXTENT * weight) } else { own }
}

impl LightTree {
    pub(in crate::lights) fn len(&self) -> usize {
        self.leaves.len()
    }

    /// The weights of a node's children for a diffuse receiver.
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

    /// The weights of a node's children for a glossy receiver, and for a diffuse one in its place.
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

    /// The weights of a node's children for a receiver.
    pub(super) fn raised_weights<F: Fn(u32) -> LampIrradiance>(&self, node: u32, question: &TreeQuery<'_, F>) -> Lanes {
        match &question.receiver.gloss {
            None => self.weights(node, question),
            Some(gloss) => self.glossy_weights(node, question, gloss).raised,
        }
    }

    /// The selection weights of a node's children.
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

/// Turns a row of weights into selection weights: [`MATT_SHARE`] by the weights for a diffuse receiver, the rest by the raised weights.
/// Returns the sum of the raised ones.
#[inline(always)]
pub(super) fn mix(raised: &mut [f32], plain: &[f32]) -> f32 {
    let (total, plain_total) = (raised.iter().sum::<f32>(), plain.iter().sum::<f32>());
    // Below, quotients would not be finite; then no fraction uses the diffuse weights.
    if total >= f32::MIN_POSITIVE && plain_total >= f32::MIN_POSITIVE {
        let (per_total, per_plain) = ((1.0 - MATT_SHARE) / total, MATT_SHARE / plain_total);
        for (raised, plain) in raised.iter_mut().zip(plain) {
            *raised = *raised * per_total + plain * per_plain;
        }
    }
    total
}
