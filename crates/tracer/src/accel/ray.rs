//! A ray as boxes and triangles want it.

use super::lanes::{Eight, Lanes};
use super::node::Node;
use glam::Vec3;

/// Below this a component of a direction counts as this small: its reciprocal stays finite, and the ray strays by less
/// than any coordinate's rounding.
const LEAST_COMPONENT: f32 = 1e-18;
/// Shrinks the entry into a box by more than the rounding of the three operations that made it, and of those that made
/// the exit: 2·3 roundings of 2⁻²⁴ (after Ize 2013, "Robust BVH ray traversal"), and as many for the triangle's.
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
        let inverse = direction.to_array().map(inverse);
        Self { origin: origin.to_array(), inverse, near: inverse.map(|x| usize::from(x < 0.0)) }
    }
}

/// Reciprocal of a direction's component, finite. −0 counts as +0.
#[inline(always)]
fn inverse(d: f32) -> f32 {
    let d = d + 0.0;
    if d.abs() < LEAST_COMPONENT { (1.0 / LEAST_COMPONENT).copysign(d) } else { 1.0 / d }
}

/// A slab ray spread over lanes.
#[derive(Clone, Copy)]
pub(super) struct SlabLanes<L: Lanes> {
    origin: [L::V; 3],
    inverse: [L::V; 3],
    near: [usize; 3],
    shrink: L::V,
    zero: L::V,
}

impl<L: Lanes> SlabLanes<L> {
    #[inline(always)]
    pub(super) fn new(l: L, ray: &SlabRay) -> Self {
        Self {
            origin: ray.origin.map(|x| l.splat(x)),
            inverse: ray.inverse.map(|x| l.splat(x)),
            near: ray.near,
            shrink: l.splat(ENTRY_SHRINK),
            zero: l.splat(0.0),
        }
    }

    /// Which of a node's boxes the ray enters at or before `limit`, and where.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node, limit: f32) -> (u32, Eight) {
        let [nx, ny, nz] = [self.plane(l, node, 0, 0), self.plane(l, node, 1, 0), self.plane(l, node, 2, 0)];
        let [fx, fy, fz] = [self.plane(l, node, 0, 1), self.plane(l, node, 1, 1), self.plane(l, node, 2, 1)];
        let near = l.max(l.mul(l.max(l.max(nx, ny), nz), self.shrink), self.zero);
        let far = l.min(l.min(fx, fy), l.min(fz, l.splat(limit)));
        (l.bits(l.le(near, far)), l.store(near))
    }

    /// Where the ray meets the first (`far` = 0) or last (1) planes of an axis.
    #[inline(always)]
    fn plane(&self, l: L, node: &Node, axis: usize, far: usize) -> L::V {
        let planes = l.load(&node.planes[axis][(self.near[axis] ^ far) & 1]);
        l.mul(l.sub(planes, self.origin[axis]), self.inverse[axis])
    }
}
