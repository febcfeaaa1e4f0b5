//! Up to eight triangles, met at once.
//!
//! The test is watertight: two triangles that share an edge agree, bit by bit, on which side of it a ray passes. Corners
//! are taken relative to the ray's origin and sheared along the ray, the same way for every triangle; the sign of an
//! edge function is then that of the difference of two rounded products, which is never the wrong one, and where it is
//! zero it is found again in f64, where those products are exact (Woop, Benthin, Wald 2013). Edges count as inside.
//!
//! Whether the surface lies before or behind the origin matters for rays that leave it: t is a mean of the corners'
//! depths, so its sign is certain where those have one sign, or where it exceeds its error bound (Pharr, Jakob,
//! Humphreys 2023, section 6.8.7); else t is found again in f64 from the triangle's plane.

use super::lanes::{Eight, Lanes};
use super::local::LocalRay;
use glam::{DVec3, Vec3};

/// Eight triangles, corner by corner and axis by axis. Lanes without a triangle hold NaN, which no ray meets.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Packet {
    corners: [[Eight; 3]; 3],
    primitives: [u32; 8],
}

/// Where a ray meets the triangles of a packet, for the lanes it meets. Iterates over them.
pub(super) struct Meeting<'a> {
    lanes: u32,
    t: Eight,
    u: Eight,
    v: Eight,
    primitives: &'a [u32; 8],
}

/// A primitive that a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimitiveHit {
    pub(super) t: f32,
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) primitive: u32,
}

impl Iterator for Meeting<'_> {
    type Item = PrimitiveHit;

    #[inline(always)]
    fn next(&mut self) -> Option<PrimitiveHit> {
        if self.lanes == 0 {
            return None;
        }
        let lane = self.lanes.trailing_zeros() as usize & 7;
        self.lanes &= self.lanes - 1;
        Some(PrimitiveHit { t: self.t.0[lane], u: self.u.0[lane], v: self.v.0[lane], primitive: self.primitives[lane] })
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
        let (origin, [x, y, z]) = (ray.origin.to_array(), ray.axes);
        Self {
            origin: [l.splat(origin[x]), l.splat(origin[y]), l.splat(origin[z])],
            shear: [l.splat(ray.shear[0]), l.splat(ray.shear[1])],
            scale: l.splat(ray.scale),
            axes: ray.axes,
        }
    }
}

/// A corner of each triangle, relative to the origin and sheared, or another triple of that kind.
#[derive(Clone, Copy)]
struct Triple<V> {
    x: V,
    y: V,
    z: V,
}

impl Packet {
    /// A packet of at most eight triangles.
    pub(super) fn new(triangles: &[(u32, [Vec3; 3])]) -> Self {
        let mut packet = Self { corners: [[Eight([f32::NAN; 8]); 3]; 3], primitives: [u32::MAX; 8] };
        for (lane, (primitive, corners)) in triangles.iter().enumerate() {
            packet.primitives[lane] = *primitive;
            for (corner, position) in corners.iter().enumerate() {
                for axis in 0..3 {
                    packet.corners[corner][axis].0[lane] = position[axis];
                }
            }
        }
        packet
    }

    /// Which triangles the ray meets with 0 < t ≤ `limit`, and where.
    #[inline(always)]
    pub(super) fn meet<L: Lanes>(&self, l: L, spread: &RayLanes<L>, ray: &LocalRay, limit: f32) -> Option<Meeting<'_>> {
        let zero = l.splat(0.0);
        let [a, b, c] = [self.corner(l, spread, 0), self.corner(l, spread, 1), self.corner(l, spread, 2)];
        let edges = Triple { x: edge(l, b, c), y: edge(l, c, a), z: edge(l, a, b) };
        let least = l.min(l.min(edges.x, edges.y), edges.z);
        let most = l.max(l.max(edges.x, edges.y), edges.z);
        let inside = l.or(l.le(zero, least), l.le(most, zero));
        if l.bits(inside) == 0 {
            return None;
        }
        let sum = l.add(l.add(edges.x, edges.y), edges.z);
        let depth = l.add(l.add(l.mul(edges.x, a.z), l.mul(edges.y, b.z)), l.mul(edges.z, c.z));
        let t = l.mul(l.div(depth, sum), spread.scale);
        let hit = l.bits(l.and(inside, l.and(l.lt(zero, t), l.le(t, l.splat(limit)))));
        // An edge function that is zero is the least magnitude there is.
        let smallest = l.min(l.min(l.abs(edges.x), l.abs(edges.y)), l.abs(edges.z));
        let doubtful = l.bits(l.and(inside, l.or(l.le(smallest, zero), doubtful_depth(l, [a, b, c], depth))));
        if hit | doubtful == 0 {
            return None;
        }
        let (u, v) = (l.div(edges.y, sum), l.div(edges.z, sum));
        let mut meeting = Meeting {
            lanes: hit & !doubtful,
            t: l.store(t),
            u: l.store(u),
            v: l.store(v),
            primitives: &self.primitives,
        };
        if doubtful != 0 {
            self.settle(ray, limit, doubtful, &mut meeting);
        }
        Some(meeting)
    }

    #[inline(always)]
    fn corner<L: Lanes>(&self, l: L, ray: &RayLanes<L>, corner: usize) -> Triple<L::V> {
        let [x, y, z] =
            [self.relative(l, ray, corner, 0), self.relative(l, ray, corner, 1), self.relative(l, ray, corner, 2)];
        Triple { x: l.sub(x, l.mul(ray.shear[0], z)), y: l.sub(y, l.mul(ray.shear[1], z)), z }
    }

    #[inline(always)]
    fn relative<L: Lanes>(&self, l: L, ray: &RayLanes<L>, corner: usize, axis: usize) -> L::V {
        l.sub(l.load(&self.corners[corner][ray.axes[axis]]), ray.origin[axis])
    }

    /// Decides doubtful lanes in f64.
    #[cold]
    #[inline(never)]
    fn settle(&self, ray: &LocalRay, limit: f32, doubtful: u32, meeting: &mut Meeting<'_>) {
        for lane in (0..8).filter(|lane| doubtful >> lane & 1 == 1) {
            let corners: [Vec3; 3] =
                core::array::from_fn(|corner| Vec3::from_array(self.corners[corner].map(|axis| axis.0[lane])));
            if let Some((t, u, v)) = exact(corners, ray).filter(|(t, ..)| *t > 0.0 && *t <= limit) {
                meeting.lanes |= 1 << lane;
                (meeting.t.0[lane], meeting.u.0[lane], meeting.v.0[lane]) = (t, u, v);
            }
        }
    }
}

/// p × q of two sheared corners. Exchanging them changes the sign and nothing else.
#[inline(always)]
fn edge<L: Lanes>(l: L, p: Triple<L::V>, q: Triple<L::V>) -> L::V {
    l.sub(l.mul(p.x, q.y), l.mul(p.y, q.x))
}

/// Lanes where the sign of the depth is not certain: the corners' depths are not of one sign, and their mean is within
/// its error. With e = 2⁻²⁴ and greatest magnitudes x, y, z of the corners' coordinates, a sheared coordinate errs by
/// 5e(x + z), an edge function by 2(2e·xy + 5e(x + z)y + 5e(y + z)x) and is at most 2xy, the sum of the three
/// products by 3z·(error of an edge function + 4e·2xy): less than e·z·(96·xy + 30·z(x + y)).
#[inline(always)]
fn doubtful_depth<L: Lanes>(l: L, corners: [Triple<L::V>; 3], depth: L::V) -> L::M {
    const E: f32 = f32::EPSILON / 2.0;
    let zero = l.splat(0.0);
    let [a, b, c] = corners;
    let low = l.min(l.min(a.z, b.z), c.z);
    let high = l.max(l.max(a.z, b.z), c.z);
    let astride = l.and(l.le(low, zero), l.le(zero, high));
    let [x, y, z] = [greatest(l, a.x, b.x, c.x), greatest(l, a.y, b.y, c.y), greatest(l, a.z, b.z, c.z)];
    let square = l.mul(l.splat(100.0 * E), l.mul(x, y));
    let cross = l.mul(l.splat(32.0 * E), l.mul(z, l.add(x, y)));
    l.and(astride, l.le(l.abs(depth), l.mul(z, l.add(square, cross))))
}

/// The greatest magnitude.
#[inline(always)]
fn greatest<L: Lanes>(l: L, p: L::V, q: L::V, r: L::V) -> L::V {
    l.max(l.max(l.abs(p), l.abs(q)), l.abs(r))
}

/// The test for one triangle in f64, on the same sheared f32 corners: t, and the weights of vertices 1 and 2.
fn exact(corners: [Vec3; 3], ray: &LocalRay) -> Option<(f32, f32, f32)> {
    let [a, b, c] = corners.map(|p| sheared(p, ray));
    let product = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
    let edges = DVec3::new(product(b, c), product(c, a), product(a, b));
    let sum = edges.x + edges.y + edges.z;
    if !(edges.min_element() >= 0.0 || edges.max_element() <= 0.0) || sum == 0.0 {
        return None;
    }
    let mean = edges.dot(DVec3::new(a.z, b.z, c.z)) / sum * f64::from(ray.scale);
    let t = plane(corners.map(Vec3::as_dvec3), ray).unwrap_or(mean);
    Some((t as f32, (edges.y / sum) as f32, (edges.z / sum) as f32))
}

fn sheared(p: Vec3, ray: &LocalRay) -> DVec3 {
    let relative = p - ray.origin;
    let [x, y, z] = ray.axes.map(|axis| relative[axis]);
    Vec3::new(x - ray.shear[0] * z, y - ray.shear[1] * z, z).as_dvec3()
}

/// Where the ray meets the triangle's plane; `None` where it runs along it.
fn plane([a, b, c]: [DVec3; 3], ray: &LocalRay) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let t = normal.dot(a - ray.origin.as_dvec3()) / normal.dot(ray.direction.as_dvec3());
    t.is_finite().then_some(t)
}
