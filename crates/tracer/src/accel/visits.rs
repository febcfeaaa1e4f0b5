//! Visits of rays: a measure of a tree's quality, free of a machine's noise.

use core::cell::Cell;

use super::lanes::{F32x4, F32x8, LaneTask, Lanes, Plain, PlaneOffset, Visit};

/// Number of visits of one or more rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes, of the trees over instances and over triangles; eight boxes are tested at each.
    pub nodes: u64,
    /// Leaves of meshes; up to eight triangles are tested at each.
    pub leaves: u64,
    pub instances: u64,
}

/// Plain lanes that count.
#[derive(Clone, Copy)]
pub(super) struct VisitCounter<'a>(pub(super) &'a Cell<Visits>);

/// Methods that forward to [`Plain`].
macro_rules! plain {
    ($(fn $name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(#[inline(always)]
        fn $name(self, $($argument: $type),*) -> $result {
            Plain.$name($($argument),*)
        })*
    };
}

impl Lanes for VisitCounter<'_> {
    type V = F32x8;
    type M = [bool; 8];

    plain! {
        fn load_of(six: &[F32x8; 6], at: PlaneOffset) -> F32x8;
        fn load_halves(low: &F32x4, high: &F32x4) -> F32x8;
        fn store(v: F32x8) -> F32x8;
        fn splat(x: f32) -> F32x8;
        fn add(a: F32x8, b: F32x8) -> F32x8;
        fn sub(a: F32x8, b: F32x8) -> F32x8;
        fn mul(a: F32x8, b: F32x8) -> F32x8;
        fn mul_sub(a: F32x8, b: F32x8, c: F32x8) -> F32x8;
        fn div(a: F32x8, b: F32x8) -> F32x8;
        fn min(a: F32x8, b: F32x8) -> F32x8;
        fn max(a: F32x8, b: F32x8) -> F32x8;
        fn abs(a: F32x8) -> F32x8;
        fn le(a: F32x8, b: F32x8) -> [bool; 8];
        fn lt(a: F32x8, b: F32x8) -> [bool; 8];
        fn and(a: [bool; 8], b: [bool; 8]) -> [bool; 8];
        fn or(a: [bool; 8], b: [bool; 8]) -> [bool; 8];
        fn bits(m: [bool; 8]) -> u32;
    }

    fn record_visit(self, visit: Visit) {
        let mut visits = self.0.get();
        match visit {
            Visit::Node => visits.nodes += 1,
            Visit::Leaf => visits.leaves += 1,
            Visit::Instance => visits.instances += 1,
        }
        self.0.set(visits);
    }

    fn run<J: LaneTask>(self, job: J) -> J::Output {
        job.work(self)
    }
}
