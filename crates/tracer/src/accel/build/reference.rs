//! What trees are built over: boxes of primitives.

use crate::accel::boxes::Box3;
use glam::Vec4;

/// Makes the bits of any primitive's number (below 2³⁰) those of a plain f32: arithmetic with subnormal numbers, such as small
/// whole numbers are, takes a hundred times as long even in a lane that nobody reads.
const PLAIN: u32 = 0x4000_0000;

/// The box of a primitive or of a piece of it, and the primitive's number: 32 bytes, in two registers of four lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    /// Least coordinates; the fourth lane holds the bits of the primitive's number and takes no part in arithmetic.
    low: Vec4,
    /// Greatest coordinates; the fourth lane is 0.
    high: Vec4,
}

impl Reference {
    pub(super) fn new(bounds: &Box3, primitive: u32) -> Self {
        Self { low: bounds.low.extend(f32::from_bits(primitive | PLAIN)), high: bounds.high.extend(0.0) }
    }

    pub(super) fn primitive(&self) -> u32 {
        self.low.w.to_bits() & !PLAIN
    }

    pub(super) fn bounds(&self) -> Box3 {
        Box3 { low: self.low.truncate(), high: self.high.truncate() }
    }

    /// Half the sum of least and greatest coordinates; without meaning in the fourth lane.
    #[inline(always)]
    pub(super) fn centre(&self) -> Vec4 {
        self.low * 0.5 + self.high * 0.5
    }
}

/// A box to which others are added, in lanes: the fourth lane has no meaning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    low: Vec4,
    high: Vec4,
}

impl Extent {
    /// The box about nothing.
    pub(super) const NOTHING: Self = Self { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };

    #[inline(always)]
    pub(super) fn add(&mut self, reference: &Reference) {
        self.low = self.low.min(reference.low);
        self.high = self.high.max(reference.high);
    }

    #[inline(always)]
    pub(super) fn add_point(&mut self, point: Vec4) {
        self.low = self.low.min(point);
        self.high = self.high.max(point);
    }

    #[inline(always)]
    pub(super) fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half the area of the surface; of the box about nothing, without meaning.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let e = self.high - self.low;
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    pub(super) fn low(&self) -> Vec4 {
        self.low
    }

    /// Edges of the box.
    pub(super) fn size(&self) -> Vec4 {
        self.high - self.low
    }

    pub(super) fn bounds(&self) -> Box3 {
        Box3 { low: self.low.truncate(), high: self.high.truncate() }
    }
}
