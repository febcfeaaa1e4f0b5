//! Selection of a local light: a tree over all emitters in the scene, traversed for each receiver.
//!
//! After Conty Estevez and Kulla 2018 ("Importance sampling of many lights with adaptive tree splitting"). A cluster stores a bounding sphere, its
//! intensity and the cone of its light. From these follows a bound-like estimate of the irradiance at a receiver. A cluster is entered with a
//! probability proportional to this estimate. Differences here: nodes have eight children, whose estimates are computed four at once; leaves that are
//! lamps are weighted by their own intensity towards the receiver. A sample costs O(log n). [`LightTree::probability`] follows the path to a light
//! with the same arithmetic in the same order, so that it returns the same bits as [`LightTree::sample`].
//!
//! An estimate is zero only where the light is certainly zero (behind the emitter, below the receiver's horizon).
//!
//! Measured on a street at night (lamps of a batwing grid of type C in two rows, 15 m apart, 7 m high, four bounces; mean relative variance of a
//! pixel at 4 samples × time, against a uniform choice among all lamps): 50 lamps 2.33 → 0.075 at 1.7 times the time, 1 000 lamps 12.0 → 0.14 at 2
//! times the time. Choosing one of two to four candidates by resampling (Talbot, Cline and Egbert 2005) reduces the variance of direct light alone by
//! another half to nine tenths, but with bounces costs more time than it saves (0.141 → 0.194, 0.247, 0.340 variance × µs for two, three, four of 50
//! lamps): left out.
//!
//! A glossy receiver's lobes raise the estimates (`lights/gloss.rs`), and it chooses from a finer cut of the tree, as does a diffuse one in view
//! ([`cut`]); docs/decisions/light-choice.md has the figures.

mod bounds;
mod build;
mod cut;
#[cfg(test)]
mod glossy_tests;
mod light_tree;
mod node;
#[cfg(test)]
mod tests;

use crate::lights::light_sample::LampIrradiance;
use cut::{fraction_of_total, sample_index};
use light_tree::ParentSlot;
use node::LANES;

pub(super) use bounds::LightBounds;
pub(super) use cut::TreeStart;
pub(super) use light_tree::{DIFFUSE_FRACTION, LightTree, TreeQuery};

impl LightTree {
    /// The light selected by `u` in [0, 1), and its probability; `None` if nothing reaches the receiver, unless there is only one light.
    /// `start` is this receiver's.
    pub(super) fn sample<F: Fn(u32) -> LampIrradiance>(
        &self,
        query: &TreeQuery<'_, F>,
        start: &TreeStart,
        u: f64,
    ) -> Option<(usize, f32)> {
        let (slot, mut probability, mut u) = start.sample(u)?;
        let mut child = self.nodes[slot.node as usize].child(usize::from(slot.lane));
        while child.is_node {
            let (lane, child_probability, within) = sample_index(&self.selection_weights(child.index, query), u)?;
            probability *= child_probability;
            u = within;
            child = self.nodes[child.index as usize].child(lane);
        }
        Some((child.index as usize, probability))
    }

    /// The probability with which [`LightTree::sample`] returns a light.
    pub(super) fn probability<F: Fn(u32) -> LampIrradiance>(
        &self,
        query: &TreeQuery<'_, F>,
        start: &TreeStart,
        light: usize,
    ) -> f32 {
        self.reach(query, start, self.leaves[light])
    }

    /// Probability of reaching a slot.
    fn reach<F: Fn(u32) -> LampIrradiance>(
        &self,
        query: &TreeQuery<'_, F>,
        start: &TreeStart,
        slot: ParentSlot,
    ) -> f32 {
        if let Some(probability) = start.probability(slot) {
            return probability;
        }
        let above = match slot.node {
            // A slot that cannot be reached from the start has been evaluated and has zero weight.
            0 => 0.0,
            node => self.reach(query, start, self.parents[node as usize]),
        };
        if above > 0.0 {
            above * fraction_of_total(&self.selection_weights(slot.node, query), usize::from(slot.lane))
        } else {
            0.0
        }
    }

    /// Estimate of the irradiance at the receiver, W·m⁻²·nm⁻¹: finer if the largest cluster is near.
    pub(super) fn irradiance<F: Fn(u32) -> LampIrradiance>(&self, query: &TreeQuery<'_, F>, start: &TreeStart) -> f64 {
        let mut weights = match start {
            TreeStart::Cut(cut) => return self.scale * f64::from(cut.total()),
            TreeStart::Root(weights) => *weights,
            TreeStart::Only => self.gloss_weights(0, query),
        };
        let (mut node, mut sum) = (0, 0.0);
        loop {
            let total: f32 = weights.iter().sum();
            let lane = (0..LANES).fold(0, |best, i| if weights[i] > weights[best] { i } else { best });
            let child = self.nodes[node as usize].child(lane);
            if !child.is_node || self.nodes[node as usize].is_far(lane, query.receiver.position) {
                return self.scale * (sum + f64::from(total));
            }
            // Not by subtraction, in which weak lights vanish.
            weights[lane] = 0.0;
            sum += f64::from(weights.iter().sum::<f32>());
            node = child.index;
            weights = self.gloss_weights(node, query);
        }
    }
}
