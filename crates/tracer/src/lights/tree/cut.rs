//! The cut of the tree that a glossy receiver chooses from.
//!
//! The mean of a narrow lobe over a cluster tells nothing of the one lamp in it that is mirrored. So clusters that a lobe sees parts of
//! are opened before anything is chosen, from the root on, until none is left that is wider than the lobe and reaches into it, or
//! [`OPENED`] nodes are open. What is chosen from are lights and clusters that a lobe takes for points. (Conty Estevez and
//! Kulla 2018 open clusters that are near in the same manner, and sample each; here one of all is drawn.)

use super::node::LANES;
use super::{LightTree, Slot, TreeQuery};
use crate::lights::ReceiverGloss;

/// Nodes opened at most.
const OPENED: usize = 16;

/// Lights and clusters of all that a receiver chooses from, by their slots.
pub(super) struct Cut {
    slots: [Slot; OPENED * LANES],
    weights: [f32; OPENED * LANES],
    len: usize,
    total: f32,
}

impl LightTree {
    pub(super) fn cut<F: Fn(u32) -> f32>(&self, question: &TreeQuery<'_, F>, gloss: &ReceiverGloss) -> Cut {
        let mut cut =
            Cut { slots: [Slot::default(); OPENED * LANES], weights: [0.0; OPENED * LANES], len: 0, total: 0.0 };
        let mut open = [0_u32; OPENED];
        let (mut next, mut opened) = (0, 1);
        while next < opened {
            let index = open[next];
            let node = &self.nodes[index as usize];
            let weights = self.weights(index, question);
            for (lane, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
                let child = node.child(lane);
                if child.is_node && opened < OPENED && node.is_divided(lane, question.receiver.position, gloss) {
                    open[opened] = child.index;
                    opened += 1;
                } else {
                    cut.push(Slot { node: index, lane: lane as u8 }, weight);
                }
            }
            next += 1;
        }
        cut
    }
}

impl Cut {
    fn push(&mut self, slot: Slot, weight: f32) {
        self.slots[self.len] = slot;
        self.weights[self.len] = weight;
        self.len += 1;
        self.total += weight;
    }

    /// Sum of all weights.
    pub(super) fn total(&self) -> f32 {
        self.total
    }

    /// The slot that `u` in [0, 1) falls on, its probability, and where in it `u` lies; `None` where nothing counts.
    pub(super) fn draw(&self, u: f64) -> Option<(Slot, f32, f64)> {
        let (i, within) = super::fall(&self.weights[..self.len], self.total, u)?;
        Some((self.slots[i], self.weights[i] / self.total, within))
    }

    /// The probability of a slot; `None` where it is no part of the cut.
    pub(super) fn share(&self, slot: Slot) -> Option<f32> {
        let i = self.slots[..self.len].iter().position(|other| *other == slot)?;
        Some(self.weights[i] / self.total)
    }
}
