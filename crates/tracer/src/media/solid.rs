//! The inside of a closed mesh, as the parts of a line that lie in it.
//!
//! A point is inside if a ray from it crosses the surface an odd number of times. Crossings are found without gaps and without duplicates at edges.
//! In the plane across the line each triangle's edge functions, in f64, are equal up to sign in both triangles of an edge (Woop, Benthin and Wald,
//! "Watertight ray/triangle intersection", JCGT 2, 2013). A line that hits an edge or a vertex exactly is treated as one next to it, the same for all
//! triangles.

use core::ops::Range;
use std::collections::BTreeMap;

use glam::DVec3;

/// Maximum number of triangles per leaf.
const LEAF: usize = 4;

/// Error of a mesh without an inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SolidError {
    /// Edges that an odd number of triangles share.
    #[error(
        "the mesh is not closed: {open} of its {all} edges belong to an odd number of triangles; close its holes, so that it has \
         an interior"
    )]
    Open {
        /// Number of such edges.
        open: usize,
        /// Number of all edges.
        all: usize,
    },
    /// No triangles, or a vertex that is not finite.
    #[error("the mesh has no triangles, or vertices that are not finite; give a mesh that encloses a volume")]
    Empty,
}

/// The inside of a closed mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    vertices: Vec<DVec3>,
    /// In the order of the leaves.
    triangles: Vec<[u32; 3]>,
    nodes: Vec<SolidNode>,
}

/// A box over triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SolidNode {
    low: DVec3,
    high: DVec3,
    /// Its triangles.
    first: u32,
    count: u32,
    /// Index of the second half (the first one follows this node); 0 for a leaf.
    second: u32,
}

impl Solid {
    /// The inside of triangles over vertices. Vertices at the same place are merged.
    ///
    /// # Errors
    /// If edges belong to an odd number of triangles, or there are no triangles.
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, SolidError> {
        let (vertices, numbers) = welded(positions);
        let renamed = triangles.iter().map(|triangle| triangle.map(|i| numbers[i as usize]));
        let mut triangles: Vec<[u32; 3]> = renamed.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        if triangles.is_empty() || !vertices.iter().all(|vertex| vertex.is_finite()) {
            return Err(SolidError::Empty);
        }
        check_closed(&triangles)?;
        let mut nodes = vec![];
        let count = triangles.len();
        build(&vertices, &mut triangles, 0..count, &mut nodes);
        Ok(Self { vertices, triangles, nodes })
    }

    /// The parts of a ray that lie inside, between 0 and `end` in lengths of `direction`, in order.
    pub(super) fn parts(&self, origin: DVec3, direction: DVec3, end: f64) -> Vec<(f64, f64)> {
        let mut crossings = self.crossings(origin, direction);
        crossings.sort_by(f64::total_cmp);
        // An odd number of crossings: the ray begins inside.
        let begins = if crossings.len() % 2 == 1 { Some(0.0) } else { None };
        let ends: Vec<f64> = begins.into_iter().chain(crossings).collect();
        let parts = ends.chunks_exact(2).map(|pair| (pair[0], pair[1].min(end)));
        parts.filter(|(from, to)| from < to).collect()
    }

    /// Crossings of a ray with the surface, in lengths of its direction, beyond its origin.
    fn crossings(&self, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let (line, inverse) = (LocalLine::new(origin, direction), direction.recip());
        let mut distances = vec![];
        let mut at = vec![0_u32];
        while let Some(i) = at.pop() {
            let node = &self.nodes[i as usize];
            if !node.is_hit(origin, inverse) {
                continue;
            }
            if node.second > 0 {
                at.extend([node.second, i + 1]);
                continue;
            }
            let triangles = &self.triangles[node.first as usize..(node.first + node.count) as usize];
            distances.extend(triangles.iter().filter_map(|triangle| line.crosses(&self.vertices, triangle)));
        }
        distances.retain(|t| *t > 0.0);
        distances
    }
}

/// The distinct places, and the index of the place of each vertex.
fn welded(positions: &[DVec3]) -> (Vec<DVec3>, Vec<u32>) {
    let (mut vertices, mut known) = (vec![], BTreeMap::new());
    let number = |position: &DVec3| {
        // −0 is 0.
        let place = *position + DVec3::ZERO;
        *known.entry(place.to_array().map(f64::to_bits)).or_insert_with(|| {
            vertices.push(place);
            vertices.len() as u32 - 1
        })
    };
    let numbers = positions.iter().map(number).collect();
    (vertices, numbers)
}

fn check_closed(triangles: &[[u32; 3]]) -> Result<(), SolidError> {
    let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for [a, b, c] in triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            *edges.entry([*a.min(b), *a.max(b)]).or_default() += 1;
        }
    }
    let open = edges.values().filter(|count| *count % 2 == 1).count();
    if open > 0 { Err(SolidError::Open { open, all: edges.len() }) } else { Ok(()) }
}

/// Boxes over a range of triangles, halved by count along the longest side.
fn build(vertices: &[DVec3], triangles: &mut [[u32; 3]], range: Range<usize>, nodes: &mut Vec<SolidNode>) {
    let Range { start: first, end } = range;
    let part = &mut triangles[first..end];
    let corners = || part.iter().flatten().map(|i| vertices[*i as usize]);
    let low = corners().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
    let high = corners().reduce(DVec3::max).unwrap_or(DVec3::ZERO);
    // Margin for rounding if a ray runs along a side.
    let room = DVec3::splat(1e-9 * low.abs().max(high.abs()).max_element());
    let at = nodes.len();
    nodes.push(SolidNode {
        low: low - room,
        high: high + room,
        first: first as u32,
        count: (end - first) as u32,
        second: 0,
    });
    if end - first <= LEAF {
        return;
    }
    let axis = (0..3).max_by(|a, b| (high - low)[*a].total_cmp(&(high - low)[*b])).unwrap_or(0);
    let middle = |triangle: &[u32; 3]| triangle.iter().map(|i| vertices[*i as usize][axis]).sum::<f64>();
    part.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    let half = first.midpoint(end);
    build(vertices, triangles, first..half, nodes);
    nodes[at].second = nodes.len() as u32;
    build(vertices, triangles, half..end, nodes);
}

impl SolidNode {
    /// True if a ray may hit the box; false only if it certainly misses.
    fn is_hit(&self, origin: DVec3, inverse: DVec3) -> bool {
        let (mut from, mut to) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            if inverse[axis].is_infinite() {
                // The ray is parallel to two of the sides; 0 · ∞ in the plane of one is undefined.
                if origin[axis] < self.low[axis] || origin[axis] > self.high[axis] {
                    return false;
                }
                continue;
            }
            let [a, b] = [self.low, self.high].map(|side| (side[axis] - origin[axis]) * inverse[axis]);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        from <= to * (1.0 + 1e-12)
    }
}

/// A line in axes of its own: across it, and along it in lengths of its direction.
struct LocalLine {
    origin: DVec3,
    /// Axis of the direction's largest component, and the two others.
    axes: [usize; 3],
    /// Slopes of the other two to that, and the length of that.
    shear: DVec3,
}

impl LocalLine {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let along = (0..3).max_by(|a, b| direction[*a].abs().total_cmp(&direction[*b].abs())).unwrap_or(2);
        let [x, y] = [(along + 1) % 3, (along + 2) % 3];
        let z = direction[along];
        Self { origin, axes: [x, y, along], shear: DVec3::new(direction[x] / z, direction[y] / z, z) }
    }

    /// Ray parameter at which the line crosses a triangle, before or beyond its origin.
    fn crosses(&self, vertices: &[DVec3], triangle: &[u32; 3]) -> Option<f64> {
        let place = |i: u32| {
            let from = vertices[i as usize] - self.origin;
            let [x, y, z] = self.axes.map(|axis| from[axis]);
            DVec3::new(x - self.shear.x * z, y - self.shear.y * z, z / self.shear.z)
        };
        let [a, b, c] = triangle.map(place);
        let side = |a: DVec3, b: DVec3| a.x * b.y - a.y * b.x;
        // The side of an edge on which the line passes. If it hits the edge, it is treated as moved by ε along x and ε² along y.
        let turns = |value: f64, a: DVec3, b: DVec3| match (value == 0.0, a.y == b.y) {
            (false, _) => value > 0.0,
            (true, false) => a.y > b.y,
            (true, true) => b.x > a.x,
        };
        let edges = [side(b, c), side(c, a), side(a, b)];
        let [p, q, r] = [turns(edges[0], b, c), turns(edges[1], c, a), turns(edges[2], a, b)];
        let total: f64 = edges.iter().sum();
        (p == q && q == r && total != 0.0).then(|| (edges[0] * a.z + edges[1] * b.z + edges[2] * c.z) / total)
    }
}

/// A box about a place, of two triangles per side: its vertices, and triangles whose vertices follow `first` others.
#[cfg(test)]
pub(crate) fn cuboid(centre: DVec3, half: DVec3, first: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
    let corner = |i: u32| centre + half * DVec3::new(sign(i & 1), sign(i >> 1 & 1), sign(i >> 2));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]].map(|triangle| triangle.map(|i| i + first));
    ((0..8).map(corner).collect(), quads.into_iter().flat_map(halves).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::MediumRegion;
    use etendue_core::maths::f64::{cos, sin};
    use etendue_core::random::philox4x32;

    fn random_numbers(i: u32) -> [f64; 8] {
        let word = |k: u32| philox4x32([i, k, 0, 0], [7, 8]).map(|w| f64::from(w) / 2_147_483_648.0 - 1.0);
        let ([a, b, c, d], [e, f, g, h]) = (word(0), word(1));
        [a, b, c, d, e, f, g, h]
    }

    /// Every chord of ten thousand rays, from inside and outside: to the rounding of f64.
    #[test]
    fn a_box_of_triangles_is_the_box() {
        let half = DVec3::new(1.0, 2.0, 0.5);
        let (vertices, triangles) = cuboid(DVec3::ZERO, half, 0);
        let (solid, shape) = (Solid::new(&vertices, &triangles).expect("closed"), MediumRegion::Box { half_m: half });
        let mut hits = 0;
        for i in 0..10_000 {
            let [a, b, c, d, e, f, g, _] = random_numbers(i);
            let (origin, direction) = (DVec3::new(a, b, c) * 3.0, DVec3::new(d, e, f));
            let end = 2.0 + g;
            let parts = solid.parts(origin, direction, end);
            match (shape.span(origin, direction, end), parts.as_slice()) {
                (None, []) => {}
                (Some((from, to)), [(enter, leave)]) => {
                    hits += 1;
                    assert!((from - enter).abs() < 1e-9 && (to - leave).abs() < 1e-9, "{i}: {from} {to} {parts:?}");
                }
                (span, parts) => panic!("{i}: {span:?} {parts:?}"),
            }
        }
        assert!(hits > 500, "{hits}");
    }

    /// Rays exactly through edges, diagonals of sides and vertices, from outside and from the middle: neither missed nor counted twice.
    #[test]
    fn edges_and_vertices_are_crossed_once() {
        let (vertices, triangles) = cuboid(DVec3::ZERO, DVec3::ONE, 0);
        let solid = Solid::new(&vertices, &triangles).expect("closed");
        let steps = || (-2..=2).map(f64::from);
        for (x, y, z) in steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| (x, y, z)))) {
            let direction = DVec3::new(x, y, z);
            if direction == DVec3::ZERO {
                continue;
            }
            let inside = solid.parts(DVec3::ZERO, direction, f64::INFINITY);
            let to = 1.0 / direction.abs().max_element();
            assert!(inside.len() == 1 && (inside[0].1 - to).abs() < 1e-12, "{direction}: {inside:?}");
            let through = solid.parts(-8.0 * direction, direction, f64::INFINITY);
            assert!(through.len() == 1 && (through[0].1 - through[0].0 - 2.0 * to).abs() < 1e-12, "{through:?}");
        }
    }

    #[test]
    fn a_ray_may_leave_and_enter_again() {
        let (mut vertices, mut triangles) = cuboid(DVec3::ZERO, DVec3::ONE, 0);
        let (more, others) = cuboid(DVec3::X * 5.0, DVec3::ONE, 8);
        vertices.extend(more);
        triangles.extend(others);
        let solid = Solid::new(&vertices, &triangles).expect("closed");
        let agree = |x: f64, end: f64, expected: [(f64, f64); 2]| {
            let parts = solid.parts(DVec3::new(x, 0.1, 0.2), DVec3::X, end);
            let is_near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() < 1e-12;
            assert!(parts.len() == 2 && parts.iter().zip(&expected).all(is_near), "{parts:?}");
        };
        agree(-3.0, 9.0, [(2.0, 4.0), (7.0, 9.0)]);
        agree(0.5, 4.0, [(0.0, 0.5), (3.5, 4.0)]);
    }

    /// A ball of 64 × 32 sides: chords are shorter at both ends by its sagittas along and across, 2 (1 − cos(π/64)) = 0.0024 of the radius, over the
    /// cosine of incidence, which is above 0.5.
    #[test]
    fn a_ball_of_triangles_is_nearly_the_ball() {
        const N: u32 = 64;
        let at = |i: u32, j: u32| {
            let (turn, tilt) = (core::f64::consts::TAU / f64::from(N), core::f64::consts::TAU / f64::from(N));
            let (phi, theta) = (turn * f64::from(i % N), tilt * f64::from(j));
            let level = if j == 0 || j == N / 2 { 0.0 } else { sin(theta) };
            DVec3::new(level * cos(phi), level * sin(phi), cos(theta))
        };
        let (mut vertices, mut triangles) = (vec![], vec![]);
        for (i, j) in (0..N).flat_map(|i| (0..N / 2).map(move |j| (i, j))) {
            for corners in [[(i, j), (i, j + 1), (i + 1, j + 1)], [(i, j), (i + 1, j + 1), (i + 1, j)]] {
                let first = vertices.len() as u32;
                vertices.extend(corners.map(|(i, j)| at(i, j)));
                triangles.push([first, first + 1, first + 2]);
            }
        }
        let solid = Solid::new(&vertices, &triangles).expect("closed at its poles and its seam");
        for i in 0..1000 {
            let [a, b, c, d, ..] = random_numbers(i);
            let aside = DVec3::new(0.0, a, b) * 0.6;
            let direction = DVec3::new(1.0, 0.1 * c, 0.1 * d);
            let origin = aside - 3.0 * direction;
            let span = MediumRegion::Ball { radius_m: 1.0 }.span(origin, direction, 9.0).expect("within");
            let parts = solid.parts(origin, direction, 9.0);
            let lost = (span.1 - span.0) - (parts[0].1 - parts[0].0);
            assert!(parts.len() == 1 && lost > -1e-9 && lost < 2.0 * 0.0025 / 0.5, "{i}: {lost}");
        }
    }

    #[test]
    fn open_meshes_have_no_inside() {
        let (vertices, mut triangles) = cuboid(DVec3::ZERO, DVec3::ONE, 0);
        triangles.pop();
        let open = Solid::new(&vertices, &triangles).expect_err("a hole");
        assert_eq!(open, SolidError::Open { open: 3, all: 18 });
        assert_eq!(Solid::new(&[], &[]).expect_err("nothing"), SolidError::Empty);
    }
}
