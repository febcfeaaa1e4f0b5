//! A ray prepared for box and triangle tests.

use glam::Vec3;

use super::lanes::{F32x8, Lanes, PlaneOffset};
use super::node::Node;

/// Minimum magnitude of a component of a direction; smaller ones are raised to it. Its reciprocal stays finite, and the ray deviates by
/// less than any coordinate's rounding.
const MIN_COMPONENT: f32 = 1e-18;
/// Shrinks the entry into a box by more than the rounding of the operations that computed it, and of those that computed the exit: 2·3
/// roundings of 2⁻²⁴ (after Ize 2013, "Robust BVH ray traversal"), and as many for the triangle's. The additional error of the difference
/// of two products, two roundings of the plane's coordinate, is covered by the boxes' padding. The difference is monotonic in that
/// coordinate, so it never places a plane before one that lies farther along the ray.
const ENTRY_SHRINK: f32 = 1.0 - 1e-6;

/// A ray prepared for box tests.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlabRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// For each axis, true if the ray hits the maximum planes first.
    is_backward: [bool; 3],
}

impl SlabRay {
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3) -> Self {
        Self::with_inverse(origin, direction.recip())
    }

    /// From an origin and the reciprocals of a direction's components; those of zeros, of either sign, become finite.
    #[inline(always)]
    pub(super) fn with_inverse(origin: Vec3, inverse: Vec3) -> Self {
        const MAX_INVERSE: f32 = 1.0 / MIN_COMPONENT;
        let inverse = inverse.to_array().map(|i| i.clamp(-MAX_INVERSE, MAX_INVERSE));
        Self { origin: origin.to_array(), inverse, is_backward: inverse.map(|i| i < 0.0) }
    }
}

/// A slab ray spread over lanes. Its intersection with a plane is plane · inverse − origin · inverse.
#[derive(Clone, Copy)]
pub(super) struct SlabLanes<L: Lanes> {
    inverse: [L::V; 3],
    /// Origin · inverse.
    start: [L::V; 3],
    /// The same, shrunk, for entries.
    entry_inverse: [L::V; 3],
    entry_start: [L::V; 3],
    /// The planes of a node that the ray hits first and last, by axis.
    first: [PlaneOffset; 3],
    last: [PlaneOffset; 3],
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

    /// The boxes of a node that the ray enters at or before `limits` or a little after, and the entries.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node, limits: L::V) -> (u32, F32x8) {
        let [nx, ny, nz] = [self.entry(l, node, 0), self.entry(l, node, 1), self.entry(l, node, 2)];
        let [fx, fy, fz] = [self.exit(l, node, 0), self.exit(l, node, 1), self.exit(l, node, 2)];
        let near = l.max(l.max(nx, ny), l.max(nz, l.splat(0.0)));
        let far = l.min(l.min(fx, fy), l.min(fz, limits));
        (l.bits(l.le(near, far)), l.store(near))
    }

    /// Intersection of the ray with the first planes of an axis, or a little before.
    #[inline(always)]
    fn entry(&self, l: L, node: &Node, axis: usize) -> L::V {
        l.mul_sub(l.load_of(&node.planes, self.first[axis]), self.entry_inverse[axis], self.entry_start[axis])
    }

    /// Intersection of the ray with the last planes of an axis.
    #[inline(always)]
    fn exit(&self, l: L, node: &Node, axis: usize) -> L::V {
        l.mul_sub(l.load_of(&node.planes, self.last[axis]), self.inverse[axis], self.start[axis])
    }
}

/// The planes that the ray hits first, or last.
#[inline(always)]
fn planes(ray: &SlabRay, is_last: bool) -> [PlaneOffset; 3] {
    let [x, y, z] = ray.is_backward.map(|is_backward| usize::from(is_backward != is_last));
    [PlaneOffset::new(x), PlaneOffset::new(2 + y), PlaneOffset::new(4 + z)]
}

/// Each of three numbers in all lanes.
#[inline(always)]
fn splat<L: Lanes>(l: L, [x, y, z]: [f32; 3]) -> [L::V; 3] {
    [l.splat(x), l.splat(y), l.splat(z)]
}

// A ray in a mesh's frame, prepared for triangle tests.
//
// Space is sheared so that the ray runs along one axis: the axis of the largest component of its direction becomes the third (Woop,
// Benthin, Wald 2013, "Watertight ray/triangle intersection", JCGT 2(1)).

/// The axes that become x, y and z, by the first of them; an even or odd order makes no difference to a two-sided test.
const AXES: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// A ray in a mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalRay {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// Reciprocals of the direction's components; infinite for zeros.
    pub(super) inverse: Vec3,
    /// The axis that becomes x.
    first: usize,
    /// The origin's coordinates along the axes that become x, y and z.
    pub(super) start: [f32; 3],
    /// Shears of x and y along z, and the length of z: t = z · scale.
    pub(super) shear: [f32; 2],
    pub(super) scale: f32,
    /// Number in the tree of the triangle that the ray leaves; [`NO_PRIMITIVE`] if it leaves none.
    pub(super) left: u32,
}

/// No triangle's number.
pub(super) const NO_PRIMITIVE: u32 = u32::MAX;

impl LocalRay {
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let first = first_axis(direction);
        let ([ox, oy, oz], [dx, dy, dz]) = (origin.to_array(), direction.to_array());
        let (o, d) = ([ox, oy, oz, ox, oy], [dx, dy, dz, dx, dy]);
        let along = d[first + 2];
        Self {
            origin,
            direction,
            inverse: direction.recip(),
            first,
            start: [o[first], o[first + 1], o[first + 2]],
            shear: [d[first] / along, d[first + 1] / along],
            scale: 1.0 / along,
            left: NO_PRIMITIVE,
        }
    }

    /// Sets the triangle that the ray leaves, by its number in the tree, or [`NO_PRIMITIVE`].
    #[inline(always)]
    pub(super) fn excluding(self, left: u32) -> Self {
        Self { left, ..self }
    }

    /// The axes that become x, y and z.
    #[inline(always)]
    pub(super) fn axes(&self) -> [usize; 3] {
        AXES[self.first.min(2)]
    }
}

/// The axis after that of the largest component of a direction. Without branches, which would be unpredictable.
#[inline(always)]
fn first_axis(direction: Vec3) -> usize {
    let [x, y, z] = direction.abs().to_array();
    let is_x = usize::from(x > y) & usize::from(x > z);
    let is_y = (1 - is_x) & usize::from(y > z);
    (is_x | is_y << 1).min(2)
}
