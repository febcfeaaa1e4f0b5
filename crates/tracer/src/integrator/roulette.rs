//! Where paths end: those that carry nothing, and others at random (Russian roulette; Arvo and Kirk 1990).

use super::effects::Effects;
use super::path::{Path, PathStep};
use etendue_core::random::Draw;

impl<const N: usize, E: Effects> Path<'_, N, E> {
    /// On, unless nothing is carried any more.
    pub(super) fn unless_dark(&self) -> PathStep {
        if self.throughput.is_zero() { PathStep::Ends } else { PathStep::Goes }
    }

    /// Russian roulette: the path goes on with the probability of its greatest throughput, and then counts for those
    /// that ended.
    pub(super) fn survives(&mut self) -> bool {
        if self.bounces < self.tracer.settings.roulette_start {
            return true;
        }
        let chance = self.prior * self.throughput.max_value();
        if chance >= 1.0 || !chance.is_finite() {
            return true;
        }
        self.throughput = self.throughput / chance;
        self.asked.stream.one(Draw::Roulette, self.bounces) < chance
    }
}
