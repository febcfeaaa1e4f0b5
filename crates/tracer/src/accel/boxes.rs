//! Axis-aligned boxes, and binary trees over them as their builders leave them.

use glam::{DVec3, Vec3};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box3 {
    /// Minimum coordinates.
    pub(crate) low: Vec3,
    /// Maximum coordinates.
    pub(crate) high: Vec3,
}

impl Box3 {
    /// A box of f64 in f32. Rounding to f32 is within the padding that is added later.
    pub(crate) fn from_f64(low: DVec3, high: DVec3) -> Self {
        Self { low: low.as_vec3(), high: high.as_vec3() }
    }

    /// The box about a triangle.
    pub(crate) fn about([a, b, c]: &[Vec3; 3]) -> Self {
        Self { low: a.min(*b).min(*c), high: a.max(*b).max(*c) }
    }

    /// True if it contains a point; false if a coordinate is NaN.
    pub(crate) fn is_valid(&self) -> bool {
        self.low.cmple(self.high).all()
    }

    /// Enlargement of a primitive's box on all sides so that no rounding of a box test loses a hit that the primitive's own test finds:
    /// 6e-7 · (maximum coordinate + maximum extent), some ten roundings.
    pub(crate) fn padding(&self) -> Vec3 {
        Vec3::splat(self.padding_by_axis().max_element())
    }

    /// As [`Box3::padding`], if both tests are of the same ray: along each axis by 6e-7 · (its maximum coordinate + the maximum extent of
    /// all), for the rounding of a sheared corner is that of its own coordinate and of the primitive's length along the ray.
    pub(crate) fn padding_by_axis(&self) -> Vec3 {
        let extent = (self.high - self.low).max_element();
        6e-7 * (self.low.abs().max(self.high.abs()) + Vec3::splat(extent))
    }

    /// The box enlarged on all sides.
    pub(crate) fn grown(&self, by: Vec3) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    pub(crate) fn centre(&self) -> Vec3 {
        self.low * 0.5 + self.high * 0.5
    }

    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half the area of the box's surface.
    pub(crate) fn half_area(&self) -> f32 {
        let e = self.high - self.low;
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

/// Marks a leaf.
const LEAF: u32 = 1 << 31;

/// A node of a binary tree: the parent of two nodes, or a leaf of one primitive. 28 bytes.
///
/// A tree's nodes are stored in one order: its root; below an inner node its two children, one after the other, then all nodes below the
/// first, then all below the second. Parents thus come before their children, and the subtree below a node is contiguous.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Box3,
    word: u32,
}

/// Content of a binary node.
#[derive(Clone, Copy, Debug)]
pub(super) enum BinaryKind {
    /// Its two children are this node and the next.
    Inner(u32),
    /// A primitive.
    Leaf(u32),
}

impl BinaryNode {
    pub(super) fn new(bounds: Box3, kind: BinaryKind) -> Self {
        let word = match kind {
            BinaryKind::Inner(first) => first,
            BinaryKind::Leaf(primitive) => primitive | LEAF,
        };
        Self { bounds, word }
    }

    #[inline(always)]
    pub(super) fn kind(&self) -> BinaryKind {
        if self.word & LEAF == 0 { BinaryKind::Inner(self.word) } else { BinaryKind::Leaf(self.word & !LEAF) }
    }
}
