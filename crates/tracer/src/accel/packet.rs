//! Up to eight triangles, tested at once.
//!
//! The test is watertight: two triangles that share an edge agree, bit by bit, on the side on which a ray passes. Corners are taken relative to the
//! ray's origin and sheared along the ray, the same way for every triangle. The sign of an edge function is then that of the difference of two
//! rounded products, which is never the wrong one. If it is zero it is computed again in f64, where those products are exact (Woop, Benthin, Wald
//! 2013). Edges count as inside.
//!
//! The sign of t matters for rays that leave a surface: t is a mean of the corners' depths, so its sign is certain if those have one sign, or if it
//! exceeds its error bound (Pharr, Jakob, Humphreys 2023, section 6.8.7). Otherwise t is computed again in f64 from the triangle's plane.

use glam::{DVec3, Vec3};

use super::lanes::{F32x4, F32x8, Lanes};
use super::ray::LocalRay;
use crate::geometry::Hit;

/// Triangles per half.
const HALF_SIZE: usize = 4;

/// Half of a packet: four triangles, corner by corner and axis by axis. Lanes without a triangle hold NaN, which no ray hits.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct HalfPacket {
    corners: [[F32x4; 3]; 3],
    primitives: [u32; HALF_SIZE],
}

/// Up to eight triangles: one half or two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packet<'a> {
    /// The same half twice if there is only one.
    halves: [&'a HalfPacket; 2],
    /// The lanes in use.
    lanes: u32,
}

/// Hits of a ray with the triangles of a packet, for the lanes it hits. Iterates over them.
pub(super) struct LaneHits<'a> {
    lanes: u32,
    t: F32x8,
    u: F32x8,
    v: F32x8,
    packet: Packet<'a>,
}

/// A primitive hit by a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimitiveHit {
    pub(super) t: f32,
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) primitive: u32,
}

impl Iterator for LaneHits<'_> {
    type Item = PrimitiveHit;

    #[inline(always)]
    fn next(&mut self) -> Option<PrimitiveHit> {
        if self.lanes == 0 {
            return None;
        }
        let lane = self.lanes.trailing_zeros() as usize & 7;
        self.lanes &= self.lanes - 1;
        Some(PrimitiveHit {
            t: self.t.0[lane],
            u: self.u.0[lane],
            v: self.v.0[lane],
            primitive: self.packet.primitive(lane),
        })
    }
}

/// A local ray spread over lanes.
#[derive(Clone, Copy)]
pub(super) struct RayLanes<L: Lanes> {
    origin: [L::V; 3],
    shear: [L::V; 2],
    scale: L::V,
    axes: [usize; 3],
}

impl<L: Lanes> RayLanes<L> {
    #[inline(always)]
    pub(super) fn new(l: L, ray: &LocalRay) -> Self {
        let [x, y, z] = ray.start;
        Self {
            origin: [l.splat(x), l.splat(y), l.splat(z)],
            shear: [l.splat(ray.shear[0]), l.splat(ray.shear[1])],
            scale: l.splat(ray.scale),
            // This tells the compiler that indices are in range, so that it omits later checks.
            axes: ray.axes().map(|axis| axis.min(2)),
        }
    }
}

/// A corner of each triangle, relative to the origin and sheared, or another triple of that kind.
#[derive(Clone, Copy)]
struct VectorLanes<V> {
    x: V,
    y: V,
    z: V,
}

/// Result of the f32 test for a packet's triangles.
struct TriangleTest<L: Lanes> {
    /// Lanes hit with 0 < t ≤ limit.
    hit: u32,
    /// Lanes that f32 cannot decide.
    doubtful: u32,
    edges: VectorLanes<L::V>,
    sum: L::V,
    t: L::V,
}

impl HalfPacket {
    /// Maximum number of triangles that it holds.
    pub(super) const SIZE: usize = HALF_SIZE;

    /// Halves, one or two, of at most eight triangles by their numbers.
    pub(super) fn from_primitives(
        primitives: &[u32],
        corners: impl Fn(u32) -> [Vec3; 3],
    ) -> impl Iterator<Item = Self> {
        primitives.chunks(HALF_SIZE).map(move |chunk| Self::new(chunk, &corners))
    }

    /// The half of at most [`HalfPacket::SIZE`] triangles by their numbers.
    pub(super) fn new(primitives: &[u32], corners: impl Fn(u32) -> [Vec3; 3]) -> Self {
        let mut half = Self { corners: [[F32x4([f32::NAN; HALF_SIZE]); 3]; 3], primitives: [u32::MAX; HALF_SIZE] };
        for (lane, primitive) in primitives.iter().enumerate() {
            half.primitives[lane] = *primitive;
            for (corner, position) in corners(*primitive).iter().enumerate() {
                for axis in 0..3 {
                    half.corners[corner][axis].0[lane] = position[axis];
                }
            }
        }
        half
    }
}

impl<'a> Packet<'a> {
    /// The packet of one half or two.
    #[inline(always)]
    pub(super) fn new(halves: &'a [HalfPacket], first: usize, second: usize) -> Self {
        let lanes = if first == second { 0x0f } else { 0xff };
        Self { halves: [&halves[first], &halves[second]], lanes }
    }

    #[inline(always)]
    fn primitive(&self, lane: usize) -> u32 {
        self.halves[(lane / HALF_SIZE) & 1].primitives[lane % HALF_SIZE]
    }

    /// Hits of the ray with triangles at 0 < t ≤ `limit`.
    #[inline(always)]
    pub(super) fn intersect<L: Lanes>(
        &self,
        l: L,
        spread: &RayLanes<L>,
        ray: &LocalRay,
        limit: f32,
    ) -> Option<LaneHits<'a>> {
        let TriangleTest { hit, doubtful, edges, sum, t } = self.test(l, spread, ray, limit)?;
        let (u, v) = (l.div(edges.y, sum), l.div(edges.z, sum));
        let mut meeting =
            LaneHits { lanes: hit & !doubtful, t: l.store(t), u: l.store(u), v: l.store(v), packet: *self };
        if doubtful != 0 {
            self.resolve_in_f64(ray, limit, doubtful, &mut meeting);
        }
        Some(meeting)
    }

    /// True if the ray hits a triangle with 0 < t < `limit`.
    #[inline(always)]
    pub(super) fn occludes<L: Lanes>(&self, l: L, spread: &RayLanes<L>, ray: &LocalRay, limit: f32) -> bool {
        let Some(test) = self.test(l, spread, ray, limit) else { return false };
        let certain = test.hit & !test.doubtful & l.bits(l.lt(test.t, l.splat(limit)));
        certain != 0 || test.doubtful != 0 && self.any_resolved(ray, limit, test.doubtful)
    }

    /// Result of the f32 test for a packet; `None` if no triangle is hit or may be.
    #[inline(always)]
    fn test<L: Lanes>(&self, l: L, spread: &RayLanes<L>, ray: &LocalRay, limit: f32) -> Option<TriangleTest<L>> {
        let zero = l.splat(0.0);
        let corners = [self.corner(l, spread, 0), self.corner(l, spread, 1), self.corner(l, spread, 2)];
        let [a, b, c] = corners;
        let edges = VectorLanes { x: edge(l, b, c), y: edge(l, c, a), z: edge(l, a, b) };
        let minimum = l.min(l.min(edges.x, edges.y), edges.z);
        let maximum = l.max(l.max(edges.x, edges.y), edges.z);
        let inside = l.or(l.le(zero, minimum), l.le(maximum, zero));
        let mut candidates = self.lanes & l.bits(inside);
        if candidates == 0 {
            return None;
        }
        let astride = self.lanes & l.bits(l.and(inside, astride(l, corners)));
        if astride != 0 {
            // Usually the surface that the ray has just left.
            candidates &= !self.behind(ray, astride);
            if candidates == 0 {
                return None;
            }
        }
        let sum = l.add(l.add(edges.x, edges.y), edges.z);
        let depth = l.add(l.add(l.mul(edges.x, a.z), l.mul(edges.y, b.z)), l.mul(edges.z, c.z));
        let t = l.mul(l.div(depth, sum), spread.scale);
        let hit = candidates & l.bits(l.and(l.lt(zero, t), l.le(t, l.splat(limit))));
        // A zero edge function has the least possible magnitude.
        let smallest = l.min(l.min(l.abs(edges.x), l.abs(edges.y)), l.abs(edges.z));
        let mut doubtful = candidates & l.bits(l.le(smallest, zero));
        if candidates & astride != 0 {
            doubtful |= candidates & astride & l.bits(uncertain_depth(l, corners, depth));
        }
        (hit | doubtful != 0).then_some(TriangleTest { hit, doubtful, edges, sum, t })
    }

    /// Those of `lanes` that the ray leaves, or whose planes are, in f64, not in front of the ray's origin.
    #[inline(always)]
    fn behind(&self, ray: &LocalRay, lanes: u32) -> u32 {
        let (mut pending, mut behind) = (lanes, 0);
        while pending != 0 {
            let lane = pending.trailing_zeros() as usize & 7;
            pending &= pending - 1;
            // The triangle that a ray leaves is flat and lies behind it.
            let is_behind = self.primitive(lane) == ray.left || self.is_behind(ray, lane);
            behind |= u32::from(is_behind) << lane;
        }
        behind
    }

    /// True if a triangle's plane is, in f64, not in front of the ray's origin.
    #[inline(always)]
    fn is_behind(&self, ray: &LocalRay, lane: usize) -> bool {
        let (height, slope) = height_and_slope(self.triangle(lane).map(Vec3::as_dvec3), ray);
        slope != 0.0 && (height == 0.0 || (height < 0.0) != (slope < 0.0))
    }

    #[inline(always)]
    fn corner<L: Lanes>(&self, l: L, ray: &RayLanes<L>, corner: usize) -> VectorLanes<L::V> {
        let [x, y, z] =
            [self.relative(l, ray, corner, 0), self.relative(l, ray, corner, 1), self.relative(l, ray, corner, 2)];
        VectorLanes { x: l.sub(x, l.mul(ray.shear[0], z)), y: l.sub(y, l.mul(ray.shear[1], z)), z }
    }

    #[inline(always)]
    fn relative<L: Lanes>(&self, l: L, ray: &RayLanes<L>, corner: usize, axis: usize) -> L::V {
        let [low, high] = self.halves.map(|half| &half.corners[corner][ray.axes[axis]]);
        l.sub(l.load_halves(low, high), ray.origin[axis])
    }

    /// Decides doubtful lanes in f64.
    #[cold]
    #[inline(never)]
    fn resolve_in_f64(&self, ray: &LocalRay, limit: f32, doubtful: u32, meeting: &mut LaneHits<'_>) {
        for lane in (0..8).filter(|lane| doubtful >> lane & 1 == 1) {
            if let Some((t, u, v)) = exact(self.triangle(lane), ray, limit) {
                meeting.lanes |= 1 << lane;
                (meeting.t.0[lane], meeting.u.0[lane], meeting.v.0[lane]) = (t, u, v);
            }
        }
    }

    /// True if one of the doubtful lanes is hit before `limit`, decided in f64.
    #[cold]
    #[inline(never)]
    fn any_resolved(&self, ray: &LocalRay, limit: f32, doubtful: u32) -> bool {
        let lanes = (0..8).filter(|lane| doubtful >> lane & 1 == 1);
        lanes.filter_map(|lane| exact(self.triangle(lane), ray, limit)).any(|(t, ..)| t < limit)
    }

    #[inline(always)]
    fn triangle(&self, lane: usize) -> [Vec3; 3] {
        let half = self.halves[(lane / HALF_SIZE) & 1];
        core::array::from_fn(|corner| Vec3::from_array(half.corners[corner].map(|axis| axis.0[lane % HALF_SIZE])))
    }
}

/// p × q of two sheared corners. Exchanging them only changes the sign.
#[inline(always)]
fn edge<L: Lanes>(l: L, p: VectorLanes<L::V>, q: VectorLanes<L::V>) -> L::V {
    l.sub(l.mul(p.x, q.y), l.mul(p.y, q.x))
}

/// Lanes whose corners' depths are not of one sign.
#[inline(always)]
fn astride<L: Lanes>(l: L, [a, b, c]: [VectorLanes<L::V>; 3]) -> L::M {
    let zero = l.splat(0.0);
    let low = l.min(l.min(a.z, b.z), c.z);
    let high = l.max(l.max(a.z, b.z), c.z);
    l.and(l.le(low, zero), l.le(zero, high))
}

/// Lanes with an uncertain sign of the depth, among those whose corners' depths are not of one sign: their mean is within its error. With e
/// = 2⁻²⁴ and maximum magnitudes x, y, z of the corners' coordinates, a sheared coordinate errs by 5e(x + z), an edge function by 2(2e·xy +
/// 5e(x + z)y + 5e(y + z)x) and is at most 2xy, the sum of the three products by 3z·(error of an edge function + 4e·2xy): less than
/// e·z·(96·xy + 30·z(x + y)).
#[inline(always)]
fn uncertain_depth<L: Lanes>(l: L, [a, b, c]: [VectorLanes<L::V>; 3], depth: L::V) -> L::M {
    const E: f32 = f32::EPSILON / 2.0;
    let [x, y, z] = [max_magnitude(l, a.x, b.x, c.x), max_magnitude(l, a.y, b.y, c.y), max_magnitude(l, a.z, b.z, c.z)];
    let square = l.mul(l.splat(100.0 * E), l.mul(x, y));
    let cross = l.mul(l.splat(32.0 * E), l.mul(z, l.add(x, y)));
    l.le(l.abs(depth), l.mul(z, l.add(square, cross)))
}

/// The maximum magnitude.
#[inline(always)]
fn max_magnitude<L: Lanes>(l: L, p: L::V, q: L::V, r: L::V) -> L::V {
    l.max(l.max(l.abs(p), l.abs(q)), l.abs(r))
}

/// The test for one triangle in f64, on the same sheared f32 corners: t with 0 < t ≤ `limit`, and the weights of vertices
/// 1 and 2.
fn exact(corners: [Vec3; 3], ray: &LocalRay, limit: f32) -> Option<(f32, f32, f32)> {
    let in_range = |t: f64| t as f32 > 0.0 && t as f32 <= limit;
    let [a, b, c] = corners.map(|p| sheared(p, ray));
    let product = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
    let edges = DVec3::new(product(b, c), product(c, a), product(a, b));
    let sum = edges.x + edges.y + edges.z;
    if !(edges.min_element() >= 0.0 || edges.max_element() <= 0.0) || sum == 0.0 {
        return None;
    }
    let mean = edges.dot(DVec3::new(a.z, b.z, c.z)) / sum * f64::from(ray.scale);
    let t = plane(corners.map(Vec3::as_dvec3), ray).unwrap_or(mean);
    in_range(t).then_some((t as f32, (edges.y / sum) as f32, (edges.z / sum) as f32))
}

fn sheared(p: Vec3, ray: &LocalRay) -> DVec3 {
    let relative = p - ray.origin;
    let [x, y, z] = ray.axes().map(|axis| relative[axis]);
    Vec3::new(x - ray.shear[0] * z, y - ray.shear[1] * z, z).as_dvec3()
}

/// Ray parameter at the triangle's plane; `None` if the ray is parallel to it.
fn plane(corners: [DVec3; 3], ray: &LocalRay) -> Option<f64> {
    let (height, slope) = height_and_slope(corners, ray);
    let t = height / slope;
    t.is_finite().then_some(t)
}

/// Distance of the triangle's plane from the ray's origin, and the part of it that the ray covers in one length of its direction, in
/// lengths of the plane's normal.
#[inline(always)]
fn height_and_slope([a, b, c]: [DVec3; 3], ray: &LocalRay) -> (f64, f64) {
    let normal = (b - a).cross(c - a);
    (normal.dot(a - ray.origin.as_dvec3()), normal.dot(ray.direction.as_dvec3()))
}

/// Owner of the primitives of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) enum PrimitiveNames<'a> {
    /// Those of one instance.
    Instance(u32),
    /// Those of several: instance and primitive by their number in the tree, in ascending order.
    Merged(&'a [(u32, u32)]),
}

impl PrimitiveNames<'_> {
    #[inline(always)]
    fn instance_and_primitive(self, primitive: u32) -> (u32, u32) {
        match self {
            Self::Instance(instance) => (instance, primitive),
            Self::Merged(names) => names[primitive as usize],
        }
    }
}

/// The best hit so far.
#[derive(Default)]
pub(super) struct BestHit {
    pub(super) hit: Option<Hit>,
}

impl BestHit {
    /// Accepts a hit that is nearer than `limit`, or as near as the best and of lesser identity; lowers the limit.
    #[inline(always)]
    pub(super) fn accept(&mut self, names: PrimitiveNames<'_>, hit: PrimitiveHit, limit: &mut f32) {
        let (instance, primitive) = names.instance_and_primitive(hit.primitive);
        let wins_tie = |best: &Hit| (instance, primitive) < (best.instance, best.primitive);
        let nearer = hit.t < *limit || hit.t == *limit && self.hit.as_ref().is_some_and(wins_tie);
        if hit.t > 0.0 && nearer {
            *limit = hit.t;
            self.hit = Some(Hit { t: hit.t, instance, primitive, u: hit.u, v: hit.v });
        }
    }
}
