//! Where paths end: those that carry nothing, and others at random (Russian roulette; Arvo and Kirk 1990).
//!
//! What a path still finds counts in its pixel by the throughput, and so does all else that the pixel shows: behind a dark
//! surface everything is dark. So the chance to go on goes by what is left of the throughput behind the first surface that
//! scatters, and not by the throughput itself. Where light is alike everywhere the best chance is in proportion to that share,
//! by the root of a whole path's cost over that of what is left of it (Bolin and Meyer 1997; Rath and others 2022, "EARS").

use super::effects::Effects;
use super::path::{Path, PathStep};
use etendue_core::random::Draw;

impl<const N: usize, E: Effects> Path<'_, N, E> {
    /// On, unless nothing is carried any more.
    pub(super) fn unless_dark(&self) -> PathStep {
        if self.throughput.is_zero() { PathStep::Ends } else { PathStep::Goes }
    }

    /// Russian roulette: a path that goes on counts for those that ended. Paths that only mirrors have scattered all go on.
    pub(super) fn survives(&mut self) -> bool {
        if self.history.is_seen() {
            return true;
        }
        let chance = self.carried.chance(self.throughput.max_value());
        if self.bounces < self.tracer.settings.roulette_start || chance >= 1.0 || !chance.is_finite() {
            return true;
        }
        self.throughput = self.throughput / chance;
        self.asked.stream.one(Draw::Roulette, self.bounces) < chance
    }
}
