//! Visits of rays: a measure of a tree's quality, free of a machine's noise.

use core::cell::Cell;

use super::lanes::{Eight, Four, Job, Lanes, OfSix, Plain, Visit};

/// Number of visits of one or more rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes, of the trees over instances and over triangles; eight boxes are tested at each.
    pub nodes: u64,
    /// Leaves of meshes; up to eight triangles are tested at each.
    pub leaves: u64,
    /// Instances.
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
    type V = Eight;
    type M = [bool; 8];

    plain! {
        fn load_of(six: &[Eight; 6], at: OfSix) -> Eight;
        fn load_halves(low: &Four, high: &Four) -> Eight;
        fn store(v: Eight) -> Eight;
        fn splat(x: f32) -> Eight;
        fn add(a: Eight, b: Eight) -> Eight;
        fn sub(a: Eight, b: Eight) -> Eight;
        fn mul(a: Eight, b: Eight) -> Eight;
        fn mul_sub(a: Eight, b: Eight, c: Eight) -> Eight;
        fn div(a: Eight, b: Eight) -> Eight;
        fn min(a: Eight, b: Eight) -> Eight;
        fn max(a: Eight, b: Eight) -> Eight;
        fn abs(a: Eight) -> Eight;
        fn le(a: Eight, b: Eight) -> [bool; 8];
        fn lt(a: Eight, b: Eight) -> [bool; 8];
        fn and(a: [bool; 8], b: [bool; 8]) -> [bool; 8];
        fn or(a: [bool; 8], b: [bool; 8]) -> [bool; 8];
        fn bits(m: [bool; 8]) -> u32;
    }

    fn note(self, visit: Visit) {
        let mut visits = self.0.get();
        match visit {
            Visit::Node => visits.nodes += 1,
            Visit::Leaf => visits.leaves += 1,
            Visit::Instance => visits.instances += 1,
        }
        self.0.set(visits);
    }

    fn run<J: Job>(self, job: J) -> J::Output {
        job.work(self)
    }
}
