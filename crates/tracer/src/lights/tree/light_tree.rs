//! The tree itself: nodes, the slots of lights and nodes, and the weights of a node's children for a receiver.

use super::node::{GlossyWeights, LANES, LightNode, NodeLanes};
use crate::lights::light_sample::LampIrradiance;
use crate::lights::{LightSampleContext, ReceiverGloss};

/// Place of a light or a node in its parent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ParentSlot {
    pub(super) node: u32,
    pub(super) lane: u8,
}

/// A tree over lights that are numbered from 0.
#[derive(Clone, Debug)]
pub(in crate::lights) struct LightTree {
    /// The root first.
    pub(super) nodes: Vec<LightNode>,
    /// Slot of each node; without meaning for the root.
    pub(super) parents: Vec<ParentSlot>,
    /// Slot of each light.
    pub(super) leaves: Vec<ParentSlot>,
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
const MIN_EXTENDED_FRACTION: f32 = 0.05;

/// Fraction of a glossy receiver's samples that uses the weights of a diffuse one. A reflected lamp may weigh 10⁴ times as much as the
/// others and more; if it is hidden, these are left with this fraction.
pub(in crate::lights) const DIFFUSE_FRACTION: f32 = 0.2;

/// The weight of a lamp of weight `own` from its middle and estimated weight `weight` as a cluster of one: parts of an opening may light
/// points that its middle does not.
#[inline(always)]
fn leaf_weight(node: &LightNode, lane: usize, own: f32, weight: f32) -> f32 {
    if node.has_extent(lane) { own.max(MIN_EXTENDED_FRACTION * weight) } else { own }
}

impl LightTree {
    pub(in crate::lights) fn len(&self) -> usize {
        self.leaves.len()
    }

    /// The weights of a node's children for a diffuse receiver.
    pub(super) fn weights<F: Fn(u32) -> LampIrradiance>(&self, node: u32, query: &TreeQuery<'_, F>) -> NodeLanes {
        let node = &self.nodes[node as usize];
        let mut weights = node.weights(query.receiver);
        for (lane, weight) in weights.iter_mut().enumerate() {
            if node.is_lamp(lane) && *weight > 0.0 {
                let own = (query.lamp)(node.child(lane).index).diffuse * self.per_irradiance;
                *weight = leaf_weight(node, lane, own, *weight);
            }
        }
        weights
    }

    /// The weights of a node's children for a glossy receiver, and for a diffuse one in its place.
    pub(super) fn glossy_weights<F: Fn(u32) -> LampIrradiance>(
        &self,
        node: u32,
        query: &TreeQuery<'_, F>,
        gloss: &ReceiverGloss,
    ) -> GlossyWeights {
        let node = &self.nodes[node as usize];
        let mut weights = node.glossy_weights(query.receiver, gloss);
        for lane in 0..LANES {
            if node.is_lamp(lane) && weights.diffuse[lane] > 0.0 {
                let lamp = (query.lamp)(node.child(lane).index);
                let of = |own: f32, weight: f32| leaf_weight(node, lane, own * self.per_irradiance, weight);
                weights.diffuse[lane] = of(lamp.diffuse, weights.diffuse[lane]);
                weights.with_gloss[lane] = of(lamp.with_gloss, weights.with_gloss[lane]);
            }
        }
        weights
    }

    /// The weights of a node's children for a receiver.
    pub(super) fn gloss_weights<F: Fn(u32) -> LampIrradiance>(&self, node: u32, query: &TreeQuery<'_, F>) -> NodeLanes {
        match &query.receiver.gloss {
            None => self.weights(node, query),
            Some(gloss) => self.glossy_weights(node, query, gloss).with_gloss,
        }
    }

    /// The selection weights of a node's children.
    pub(super) fn selection_weights<F: Fn(u32) -> LampIrradiance>(
        &self,
        node: u32,
        query: &TreeQuery<'_, F>,
    ) -> NodeLanes {
        match &query.receiver.gloss {
            None => self.weights(node, query),
            Some(gloss) => {
                let GlossyWeights { with_gloss: mut raised, diffuse: plain, .. } =
                    self.glossy_weights(node, query, gloss);
                mix(&mut raised, &plain);
                raised
            }
        }
    }
}

/// Turns a row of weights into selection weights: [`DIFFUSE_FRACTION`] by the weights for a diffuse receiver, the rest by the raised weights.
/// Returns the sum of the raised ones.
#[inline(always)]
pub(super) fn mix(raised: &mut [f32], plain: &[f32]) -> f32 {
    let (total, plain_total) = (raised.iter().sum::<f32>(), plain.iter().sum::<f32>());
    // Below, quotients would not be finite; then no fraction uses the diffuse weights.
    if total >= f32::MIN_POSITIVE && plain_total >= f32::MIN_POSITIVE {
        let (per_total, per_plain) = ((1.0 - DIFFUSE_FRACTION) / total, DIFFUSE_FRACTION / plain_total);
        for (raised, plain) in raised.iter_mut().zip(plain) {
            *raised = *raised * per_total + plain * per_plain;
        }
    }
    total
}
