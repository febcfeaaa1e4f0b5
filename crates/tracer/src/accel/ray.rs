//! A ray as boxes and triangles want it.

use super::lanes::{Eight, Lanes};
use super::node::Node;
use glam::Vec3;

/// Below this a component of a direction counts as this small: its reciprocal stays finite, and the ray strays by less
/// than any coordinate's rounding.
const LEAST_COMPONENT: f32 = 1e-18;
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
    /// For each axis, which planes the ray meets first: 0 the least ones, 1 the greatest.
    near: [usize; 3],
}

impl SlabRay {
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3) -> Self {
        let inverse = [inverse(direction.x), inverse(direction.y), inverse(direction.z)];
        let near = [usize::from(inverse[0] < 0.0), usize::from(inverse[1] < 0.0), usize::from(inverse[2] < 0.0)];
        Self { origin: origin.to_array(), inverse, near }
    }
}

/// Reciprocal of a direction's component, finite. −0 counts as +0.
#[inline(always)]
fn inverse(d: f32) -> f32 {
    let d = d + 0.0;
    if d.abs() < LEAST_COMPONENT { (1.0 / LEAST_COMPONENT).copysign(d) } else { 1.0 / d }
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
    near: [usize; 3],
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
            near: ray.near,
        }
    }

    /// Which of a node's boxes the ray enters at or before `limit`, and where.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node, limit: f32) -> (u32, Eight) {
        let [nx, ny, nz] = [self.entry(l, node, 0), self.entry(l, node, 1), self.entry(l, node, 2)];
        let [fx, fy, fz] = [self.exit(l, node, 0), self.exit(l, node, 1), self.exit(l, node, 2)];
        let near = l.max(l.max(nx, ny), l.max(nz, l.splat(0.0)));
        let far = l.min(l.min(fx, fy), l.min(fz, l.splat(limit)));
        (l.bits(l.le(near, far)), l.store(near))
    }

    /// Where the ray meets the first planes of an axis, or a little before.
    #[inline(always)]
    fn entry(&self, l: L, node: &Node, axis: usize) -> L::V {
        let planes = l.load(&node.planes[axis][self.near[axis] & 1]);
        l.mul_sub(planes, self.entry_inverse[axis], self.entry_start[axis])
    }

    /// Where the ray meets the last planes of an axis.
    #[inline(always)]
    fn exit(&self, l: L, node: &Node, axis: usize) -> L::V {
        let planes = l.load(&node.planes[axis][(self.near[axis] ^ 1) & 1]);
        l.mul_sub(planes, self.inverse[axis], self.start[axis])
    }
}

/// Each of three numbers in all lanes.
#[inline(always)]
fn splat<L: Lanes>(l: L, [x, y, z]: [f32; 3]) -> [L::V; 3] {
    [l.splat(x), l.splat(y), l.splat(z)]
}
