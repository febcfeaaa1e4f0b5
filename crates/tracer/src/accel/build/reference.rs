//! Input of tree construction: boxes of primitives.

use glam::{Vec3, Vec3A, Vec4};
use obvhs::splits::split_triangle;
use rayon::prelude::*;

use crate::accel::boxes::Box3;

/// Turns the bits of any primitive's number (below 2³⁰) into those of a normal f32. Small integers as bits are subnormal numbers, whose
/// arithmetic takes a hundred times as long even in an unused lane.
const NORMAL_BIAS: u32 = 0x4000_0000;

/// The box of a primitive or of a piece of it, and the primitive's number: 32 bytes, in two registers of four lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    /// Minimum coordinates; the fourth lane holds the bits of the primitive's number and takes no part in arithmetic.
    low: Vec4,
    /// Maximum coordinates; the fourth lane is 0.
    high: Vec4,
}

impl Reference {
    pub(super) fn new(bounds: &Box3, primitive: u32) -> Self {
        Self { low: bounds.low.extend(f32::from_bits(primitive | NORMAL_BIAS)), high: bounds.high.extend(0.0) }
    }

    pub(super) fn primitive(&self) -> u32 {
        self.low.w.to_bits() & !NORMAL_BIAS
    }

    pub(super) fn bounds(&self) -> Box3 {
        Box3 { low: self.low.truncate(), high: self.high.truncate() }
    }

    /// Half the sum of minimum and maximum coordinates; without meaning in the fourth lane.
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
    pub(super) const EMPTY: Self = Self { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };

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

    /// Half the area of the surface; for the empty box, without meaning.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let e = self.high - self.low;
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    pub(super) fn low(&self) -> Vec4 {
        self.low
    }

    pub(super) fn size(&self) -> Vec4 {
        self.high - self.low
    }

    pub(super) fn bounds(&self) -> Box3 {
        Box3 { low: self.low.truncate(), high: self.high.truncate() }
    }
}

// References to triangles: one each, but several to a triangle that is large compared with the others, each for a piece of it.
//
// Large triangles have large boxes, which many rays enter without a hit. Splitting them before the tree is built (Ernst, Greiner 2007,
// "Early split clipping for bounding volume hierarchies") costs little. The box of a piece has the padding of the whole triangle's box.

/// Ratio of a box's area to the mean from which it is worth splitting.
const MIN_AREA_RATIO: f32 = 3.0;
/// Minimum factor by which a split must reduce the sum of areas.
const MIN_GAIN: f32 = 1.8;
/// The same if the box is not much larger than the mean.
const MIN_SMALL_GAIN: f32 = 1.6;
/// Places tried along the longest axis, and one more.
const SPLIT_POSITIONS: u32 = 12;
/// A quarter more than the padding, 1.5e-7 of the coordinates, for the rounding of moving vertices.
const MOTION_PADDING: f32 = 1.25;
/// Maximum depth of splits: at most 2¹² pieces.
const MAX_SPLIT_DEPTH: u32 = 12;

/// A reference to each of `count` triangles with the given corners.
pub(super) fn unsplit_references(count: usize, corners: &(impl Fn(u32) -> [Vec3; 3] + Sync)) -> Vec<Reference> {
    let reference = |triangle| {
        let bounds = Box3::about(&corners(triangle));
        Reference::new(&bounds.grown(bounds.padding_by_axis()), triangle)
    };
    (0..count as u32).into_par_iter().map(reference).collect()
}

/// A reference to each of `count` triangles that move, by the box of all positions of each.
pub(super) fn swept(count: usize, bounds: &(impl Fn(u32) -> Box3 + Sync)) -> Vec<Reference> {
    let reference = |triangle| {
        let bounds = bounds(triangle);
        Reference::new(&bounds.grown(bounds.padding_by_axis() * MOTION_PADDING), triangle)
    };
    (0..count as u32).into_par_iter().map(reference).collect()
}

/// As [`unsplit_references`], with several references to a triangle that is large compared with the others.
pub(super) fn split_large(count: usize, corners: &(impl Fn(u32) -> [Vec3; 3] + Sync)) -> Vec<Reference> {
    let mut references = unsplit_references(count, corners);
    let limits = SplitLimits::new(&references);
    for triangle in 0..count {
        // The padded box is no smaller.
        if references[triangle].bounds().half_area() <= limits.large {
            continue;
        }
        let corners = corners(triangle as u32);
        let (mut pieces, bounds) = (Vec::new(), Box3::about(&corners));
        cut(&corners, bounds, &limits, MAX_SPLIT_DEPTH, &mut pieces);
        let padding = bounds.padding_by_axis();
        let mut pieces = pieces.into_iter().map(|piece| Reference::new(&piece.grown(padding), triangle as u32));
        references[triangle] = pieces.next().expect("a piece at least");
        references.extend(pieces);
    }
    references
}

/// Areas (half of the surface) from which boxes are split.
struct SplitLimits {
    large: f32,
    /// Below this a smaller gain is enough.
    small: f32,
}

impl SplitLimits {
    fn new(references: &[Reference]) -> Self {
        let (mut sum, mut largest) = (0.0_f64, 0.0_f32);
        for reference in references {
            let area = reference.bounds().half_area();
            sum += f64::from(area);
            largest = largest.max(area);
        }
        let mean = (sum / references.len().max(1) as f64) as f32;
        Self { large: MIN_AREA_RATIO * mean, small: (4.0 * mean).max(0.9 * mean + 0.1 * largest) }
    }
}

/// Adds the pieces of a box about a triangle, or the box itself.
fn cut(corners: &[Vec3; 3], bounds: Box3, limits: &SplitLimits, depth: u32, pieces: &mut Vec<Box3>) {
    let area = bounds.half_area();
    let parted = if depth > 0 && area > limits.large { best_cut(corners, &bounds) } else { None };
    let pays = |sum: f32| sum * MIN_GAIN < area || limits.small > area && sum * MIN_SMALL_GAIN < area;
    match parted {
        Some((sum, [low, high])) if pays(sum) => {
            cut(corners, low, limits, depth - 1, pieces);
            cut(corners, high, limits, depth - 1, pieces);
        }
        _ => pieces.push(bounds),
    }
}

/// The two boxes of the parts on both sides of a plane across the longest axis, and the sum of their areas, at its minimum.
fn best_cut(corners: &[Vec3; 3], bounds: &Box3) -> Option<(f32, [Box3; 2])> {
    let size = bounds.high - bounds.low;
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let [a, b, c] = corners.map(Vec3A::from);
    let at = |place: u32| {
        let fraction = place as f32 / SPLIT_POSITIONS as f32;
        let plane = bounds.low[axis] * fraction + bounds.high[axis] * (1.0 - fraction);
        let (low, high) = split_triangle(axis as u32, plane, [a, b, c, a]);
        let (mut below, mut above) = (*bounds, *bounds);
        (below.high[axis], above.low[axis]) = (plane, plane);
        let parts = [(low, below), (high, above)].map(|(part, limit)| Box3 {
            low: Vec3::from(part.min).max(limit.low),
            high: Vec3::from(part.max).min(limit.high),
        });
        (parts[0].half_area() + parts[1].half_area(), parts)
    };
    (1..SPLIT_POSITIONS)
        .map(at)
        .filter(|(_, parts)| parts.iter().all(Box3::is_valid))
        .reduce(|a, b| if b.0 < a.0 { b } else { a })
}
