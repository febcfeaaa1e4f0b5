//! The best hit so far.

use super::packet::PrimitiveHit;
use crate::geometry::Hit;

/// The best hit so far.
#[derive(Default)]
pub(super) struct Best {
    pub(super) hit: Option<Hit>,
}

impl Best {
    /// Takes a hit that is nearer than `limit`, or as near as the best and of lesser identity; lowers the limit.
    #[inline(always)]
    pub(super) fn offer(&mut self, instance: u32, hit: PrimitiveHit, limit: &mut f32) {
        let wins_tie = |best: &Hit| (instance, hit.primitive) < (best.instance, best.primitive);
        let nearer = hit.t < *limit || hit.t == *limit && self.hit.as_ref().is_some_and(wins_tie);
        if hit.t > 0.0 && nearer {
            *limit = hit.t;
            self.hit = Some(Hit { t: hit.t, instance, primitive: hit.primitive, u: hit.u, v: hit.v });
        }
    }
}
