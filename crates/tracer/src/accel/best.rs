//! The best hit so far.

use super::packet::PrimitiveHit;
use crate::geometry::Hit;

/// Whose primitives a tree holds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Names<'a> {
    /// Those of one instance.
    Instance(u32),
    /// Those of several: instance and primitive by their number in the tree, in ascending order.
    Merged(&'a [(u32, u32)]),
}

impl Names<'_> {
    /// Instance and primitive.
    #[inline(always)]
    fn of(self, primitive: u32) -> (u32, u32) {
        match self {
            Self::Instance(instance) => (instance, primitive),
            Self::Merged(names) => names[primitive as usize],
        }
    }
}

/// The best hit so far.
#[derive(Default)]
pub(super) struct Best {
    pub(super) hit: Option<Hit>,
}

impl Best {
    /// Takes a hit that is nearer than `limit`, or as near as the best and of lesser identity; lowers the limit.
    #[inline(always)]
    pub(super) fn offer(&mut self, names: Names<'_>, hit: PrimitiveHit, limit: &mut f32) {
        let (instance, primitive) = names.of(hit.primitive);
        let wins_tie = |best: &Hit| (instance, primitive) < (best.instance, best.primitive);
        let nearer = hit.t < *limit || hit.t == *limit && self.hit.as_ref().is_some_and(wins_tie);
        if hit.t > 0.0 && nearer {
            *limit = hit.t;
            self.hit = Some(Hit { t: hit.t, instance, primitive, u: hit.u, v: hit.v });
        }
    }
}
