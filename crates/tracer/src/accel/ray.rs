//! A ray as boxes and triangles want it.

use super::lanes::{Eight, Lanes, OfSix};
use super::node::Node;
use glam::Vec3;

/// Below this a component of a direction counts as this small: its reciprocal stays finite, and the ray strays by less
/// than any coordinate's rounding.
const MIN_COMPONENT: f32 = 1e-18;
/// Shrinks the entry into a box by more than the rounding of the operations that made it, and of those that made the
/// exit: 2·3 roundings of 2⁻²⁴ (after Ize 2013, "Robust BVH ray traversal"), and as many for the triangle's. What the
/// difference of two products errs by more, two roundings of the plane's coordinate, the boxes' padding covers; being
/// monotonic in that coordinate, it never places a plane before one that lies farther along the ray.
const ENTRY_SHRINK: f32 = 1.0 - 1e-6;

/// A ray prepared for boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlabRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// For each axis, whether the ray meets the greatest planes first.
    is_backward: [bool; 3],
}

impl SlabRay {
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3) -> Self {
        Self::with_inverse(origin, direction.recip())
    }

    /// Of an origin and the reciprocals of a direction's components; those of zeros, of either sign, become finite.
    #[inline(always)]
    pub(super) fn with_inverse(origin: Vec3, inverse: Vec3) -> Self {
        const MOST: f32 = 1.0 / MIN_COMPONENT;
        let inverse = inverse.to_array().map(|i| i.clamp(-MOST, MOST));
        Self { origin: origin.to_array(), inverse, is_backward: inverse.map(|i| i < 0.0) }
    }
}

/// A slab ray spread over lanes. Where it meets a plane is found as plane · inverse − origin · inverse.
#[derive(Clone, Copy)]
pub(super) struct SlabLanes<L: Lanes> {
    inverse: [L::V; 3],
    /// Origin · inverse.
    start: [L::V; 3],
    /// The same, shrunk, for entries.
    entry_inverse: [L::V; 3],
    entry_start: [L::V; 3],
    /// Which of a node's planes the ray meets first and last, by axis.
    first: [OfSix; 3],
    last: [OfSix; 3],
}

impl<L: Lanes> SlabLanes<L> {
    #[inline(always)]
    pub(super) fn new(l: L, ray: &SlabRay) -> Self {
        let ([x, y, z], [ox, oy, oz]) = (ray.inverse, ray.origin);
        let [ex, ey, ez] = [x * ENTRY_SHRINK, y * ENTRY_SHRINK, z * ENTRY_SHRINK];
        Self {
            inverse: splat(l, [x, y, z]),
            start: splat(l, [ox * x, oy * y, oz * z]),
            entry_inverse: splat(l, [ex, ey, ez]),
            entry_start: splat(l, [ox * ex, oy * ey, oz * ez]),
            first: planes(ray, false),
            last: planes(ray, true),
        }
    }

    /// Which of a node's boxes the ray enters at or before `limits` or a little after, and where.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node, limits: L::V) -> (u32, Eight) {
        let [nx, ny, nz] = [self.entry(l, node, 0), self.entry(l, node, 1), self.entry(l, node, 2)];
        let [fx, fy, fz] = [self.exit(l, node, 0), self.exit(l, node, 1), self.exit(l, node, 2)];
        let near = l.max(l.max(nx, ny), l.max(nz, l.splat(0.0)));
        let far = l.min(l.min(fx, fy), l.min(fz, limits));
        (l.bits(l.le(near, far)), l.store(near))
    }

    /// Where the ray meets the first planes of an axis, or a little before.
    #[inline(always)]
    fn entry(&self, l: L, node: &Node, axis: usize) -> L::V {
        l.mul_sub(l.load_of(&node.planes, self.first[axis]), self.entry_inverse[axis], self.entry_start[axis])
    }

    /// Where the ray meets the last planes of an axis.
    #[inline(always)]
    fn exit(&self, l: L, node: &Node, axis: usize) -> L::V {
        l.mul_sub(l.load_of(&node.planes, self.last[axis]), self.inverse[axis], self.start[axis])
    }
}

/// The planes that the ray meets first, or last.
#[inline(always)]
fn planes(ray: &SlabRay, is_last: bool) -> [OfSix; 3] {
    let [x, y, z] = ray.is_backward.map(|is_backward| usize::from(is_backward != is_last));
    [OfSix::new(x), OfSix::new(2 + y), OfSix::new(4 + z)]
}

/// Each of three numbers in all lanes.
#[inline(always)]
fn splat<L: Lanes>(l: L, [x, y, z]: [f32; 3]) -> [L::V; 3] {
    [l.splat(x), l.splat(y), l.splat(z)]
}
