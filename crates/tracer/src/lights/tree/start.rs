//! Where a receiver's way down the tree starts: made once, and asked for how strong the lights are and which one is drawn.

use super::cut::Cut;
use super::falling::{draw, share};
use super::light_tree::{LightTree, Slot, TreeQuery};
use super::node::LANES;
use crate::lights::light_sample::LampIrradiance;

/// What a receiver chooses from first.
#[expect(
    clippy::large_enum_variant,
    reason = "lives on the stack for one draw; a box would cost an allocation at each vertex"
)]
pub(in crate::lights) enum Start {
    /// The one light that there is, or none.
    Only,
    /// The root's children, by their weights.
    Root([f32; LANES]),
    /// For a glossy receiver, or one in view: lights and clusters of a cut.
    Cut(Cut),
}

impl LightTree {
    /// Where the way down starts.
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
    /// The slot that `u` in [0, 1) falls on, its probability, and where in it `u` lies; `None` where nothing counts.
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

    /// The probability of a slot; `None` where it is not among those that are chosen from first.
    pub(super) fn share(&self, slot: Slot) -> Option<f32> {
        match self {
            Self::Only => Some(1.0),
            Self::Cut(cut) => cut.share(slot),
            Self::Root(weights) => (slot.node == 0).then(|| share(weights, usize::from(slot.lane))),
        }
    }
}
