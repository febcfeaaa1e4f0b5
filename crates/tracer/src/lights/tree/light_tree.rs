//! The tree itself: nodes, where what hangs, and what a node's children count for a receiver.

use super::node::{LANES, Node};
use crate::lights::LightSampleContext;

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

/// A receiver with what leaves are asked for: the irradiance that a lamp gives it, W·m⁻²·nm⁻¹.
pub(in crate::lights) struct TreeQuery<'a, F: Fn(u32) -> f32> {
    pub(in crate::lights) receiver: &'a LightSampleContext,
    pub(in crate::lights) lamp: F,
}

/// Share of a cluster's estimate that a lamp with an opening counts at least, whatever its profile is worth from its middle.
const LEAST_OF_EXTENT: f32 = 0.05;

impl LightTree {
    /// How many lights there are.
    pub(in crate::lights) fn len(&self) -> usize {
        self.leaves.len()
    }

    /// What a node's children count for a receiver.
    pub(super) fn weights<F: Fn(u32) -> f32>(&self, node: u32, question: &TreeQuery<'_, F>) -> [f32; LANES] {
        let node = &self.nodes[node as usize];
        let mut weights = node.weights(question.receiver);
        for (lane, weight) in weights.iter_mut().enumerate() {
            if node.is_lamp(lane) && *weight > 0.0 {
                let own = (question.lamp)(node.child(lane).index) * self.per_irradiance;
                // Parts of an opening may light what its middle does not.
                *weight = if node.has_extent(lane) { own.max(LEAST_OF_EXTENT * *weight) } else { own };
            }
        }
        weights
    }
}
