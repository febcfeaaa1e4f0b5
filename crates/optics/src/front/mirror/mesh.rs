//! Intersection of a line with a mirror.
//!
//! A triangle-mesh mirror with smooth normals.
//!
//! A ray hits the flat triangles, but is reflected by the normal interpolated between their corners (Phong 1975), so the image has no facets: the
//! error of the directions is of second order in the triangle size. The ray/triangle test is that of Woop, Benthin and Wald ("Watertight ray/triangle
//! intersection", 2013) in double precision: a shared edge has one sign for both sides and belongs to both, so there are no leaks.

use core::fmt;

use glam::DVec3;

use crate::{error::FrontError, front::MemberRay};

/// A hit on a mirror's surface in its frame, with the normal of the reflecting side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::front) struct MirrorHit {
    pub(super) point_mm: DVec3,
    /// The geometric normal, which distinguishes the sides.
    pub(super) facing: DVec3,
    /// The shading normal used for reflection: smooth for a mesh.
    pub(super) normal: DVec3,
}

/// Maximum triangles per leaf.
const LEAF: usize = 4;
/// Depth bound of a halving tree: 2³² triangles.
const DEPTH: usize = 64;
/// Relative margin of a box for rounding.
const MARGIN: f64 = 1e-12;

/// Replaces 1/0.
const HUGE: f64 = 1e300;

#[derive(Clone, Debug, PartialEq)]
struct TreeNode {
    low: DVec3,
    high: DVec3,
    /// For a leaf, the range of `order`; else the right child; the left child follows directly.
    first: u32,
    count: u32,
}

/// The acceleration tree.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree {
    nodes: Vec<TreeNode>,
    order: Vec<u32>,
}

impl Tree {
    pub(super) fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let boxes: Vec<(DVec3, DVec3)> = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| positions[i as usize]);
                (a.min(b).min(c), a.max(b).max(c))
            })
            .collect();
        let order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), order };
        tree.split(&boxes, 0, triangles.len());
        tree
    }

    fn split(&mut self, boxes: &[(DVec3, DVec3)], from: usize, to: usize) {
        let held = self.order[from..to].iter().map(|i| boxes[*i as usize]);
        let (low, high) = held.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        let margin = DVec3::splat(MARGIN * low.abs().max(high.abs()).max_element());
        let at = self.nodes.len();
        let (first, count) = (from as u32, (to - from) as u32);
        self.nodes.push(TreeNode { low: low - margin, high: high + margin, first, count });
        if to - from <= LEAF {
            return;
        }
        let size = high - low;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = |i: &u32| boxes[*i as usize].0[axis] + boxes[*i as usize].1[axis];
        let half = (to - from) / 2;
        self.order[from..to].select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        self.split(boxes, from, from + half);
        let right = self.nodes.len() as u32;
        self.split(boxes, from + half, to);
        (self.nodes[at].first, self.nodes[at].count) = (right, 0);
    }

    /// Visits the triangles that a ray may meet nearer than `nearest`, which the visitor lowers.
    pub(super) fn visit(&self, line: &MemberRay, nearest: &mut f64, mut each: impl FnMut(u32, &mut f64)) {
        // Finite, so that no 0 · ∞ arises on a box's face.
        let inverse = DVec3::from_array(line.direction.to_array().map(|d| if d == 0.0 { HUGE } else { 1.0 / d }));
        let (mut stack, mut depth) = ([0_u32; DEPTH], 1);
        while depth > 0 {
            depth -= 1;
            let at = stack[depth] as usize;
            let node = &self.nodes[at];
            if !node.meets(line.point_mm, inverse, *nearest) {
                continue;
            }
            if node.count > 0 {
                let range = node.first as usize..(node.first + node.count) as usize;
                self.order[range].iter().for_each(|i| each(*i, nearest));
            } else {
                (stack[depth], stack[depth + 1]) = (node.first, at as u32 + 1);
                depth += 2;
            }
        }
    }
}

impl TreeNode {
    fn meets(&self, origin: DVec3, inverse: DVec3, nearest: f64) -> bool {
        let (a, b) = ((self.low - origin) * inverse, (self.high - origin) * inverse);
        let enter = a.x.min(b.x).max(a.y.min(b.y)).max(a.z.min(b.z)).max(0.0);
        let leave = a.x.max(b.x).min(a.y.max(b.y)).min(a.z.max(b.z)).min(nearest);
        enter <= leave
    }
}

#[derive(Clone, PartialEq)]
pub struct MeshMirror {
    positions_mm: Vec<DVec3>,
    normals: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    tree: Tree,
}

impl fmt::Debug for MeshMirror {
    /// Prints every vertex, normal and triangle: they determine the images.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MeshMirror({:?}, {:?}, {:?})", self.positions_mm, self.normals, self.triangles)
    }
}

impl MeshMirror {
    /// Creates a mesh of corners (mm) in its own frame and triangles, counter-clockwise as seen from the reflecting side. Without normals, each
    /// corner has the area-weighted mean normal of its triangles.
    ///
    /// # Errors
    /// If it has no triangles, a triangle refers to a missing corner or has no area, or numbers are not finite.
    pub fn new(positions_mm: Vec<DVec3>, normals: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, FrontError> {
        let refuse = |what| Err(FrontError::Mesh { what });
        if triangles.is_empty() {
            return refuse("no triangles");
        }
        if triangles.iter().flatten().any(|i| *i as usize >= positions_mm.len()) {
            return refuse("a triangle with a missing vertex");
        }
        if !positions_mm.iter().all(|p| p.is_finite()) {
            return refuse("a vertex without a finite position");
        }
        if triangles.iter().any(|t| area_normal(&positions_mm, t) == DVec3::ZERO) {
            return refuse("a triangle without area");
        }
        let normals = if normals.is_empty() { smooth(&positions_mm, &triangles) } else { normals };
        if normals.len() != positions_mm.len() {
            return refuse("a number of normals that differs from that of its vertices");
        }
        let normals: Option<Vec<DVec3>> = normals.into_iter().map(DVec3::try_normalize).collect();
        let Some(normals) = normals else { return refuse("a vertex without a normal") };
        let tree = Tree::new(&positions_mm, &triangles);
        Ok(Self { positions_mm, normals, triangles, tree })
    }

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// True if there are none; never the case.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The first hit of a ray given in its frame.
    pub(super) fn intersect(&self, line: &MemberRay) -> Option<MirrorHit> {
        let shear = AxisFrame::new(line);
        let (mut nearest, mut actual) = (f64::INFINITY, None);
        self.tree.visit(line, &mut nearest, |index, nearest| {
            let corners = self.triangles[index as usize].map(|i| self.positions_mm[i as usize]);
            if let Some((t, weights)) = shear.hit(corners).filter(|(t, _)| *t > 0.0 && *t < *nearest) {
                (*nearest, actual) = (t, Some((index, weights)));
            }
        });
        let (index, weights) = actual?;
        Some(self.at(index, weights))
    }

    fn at(&self, index: u32, weights: [f64; 3]) -> MirrorHit {
        let triangle = &self.triangles[index as usize];
        let mix = |of: &[DVec3]| -> DVec3 { triangle.iter().zip(weights).map(|(i, w)| of[*i as usize] * w).sum() };
        let facing = area_normal(&self.positions_mm, triangle).normalize();
        let normal = mix(&self.normals).try_normalize().unwrap_or(facing);
        MirrorHit { point_mm: mix(&self.positions_mm), facing, normal }
    }
}

/// Twice a triangle's area along its normal.
fn area_normal(positions: &[DVec3], triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| positions[i as usize]);
    (b - a).cross(c - a)
}

/// Corners' normals: the sum of their triangles' area normals.
fn smooth(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; positions.len()];
    for triangle in triangles {
        let normal = area_normal(positions, triangle);
        triangle.iter().for_each(|i| normals[*i as usize] += normal);
    }
    // A corner without a triangle is never hit.
    normals.into_iter().map(|n| if n == DVec3::ZERO { DVec3::Z } else { n }).collect()
}

/// The frame in which a ray runs along its longest axis.
struct AxisFrame {
    origin: DVec3,
    axes: [usize; 3],
    slope: [f64; 2],
    length: f64,
}

impl AxisFrame {
    fn new(line: &MemberRay) -> Self {
        let d = line.direction;
        let size = d.abs();
        let z = if size.x > size.y && size.x > size.z {
            0
        } else if size.y > size.z {
            1
        } else {
            2
        };
        let [x, y] = [(z + 1) % 3, (z + 2) % 3];
        Self { origin: line.point_mm, axes: [x, y, z], slope: [d[x] / d[z], d[y] / d[z]], length: d[z] }
    }

    /// Distance along the ray, and the weights of the corners.
    fn hit(&self, corners: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
        let [x, y, z] = self.axes;
        let [a, b, c] = corners.map(|p| {
            let p = p - self.origin;
            [p[x] - self.slope[0] * p[z], p[y] - self.slope[1] * p[z], p[z]]
        });
        let edge = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let weights = [edge(b, c), edge(c, a), edge(a, b)];
        let (any_below, any_above) = (weights.iter().any(|w| *w < 0.0), weights.iter().any(|w| *w > 0.0));
        if any_below && any_above {
            return None;
        }
        let sum: f64 = weights.iter().sum();
        if sum == 0.0 {
            return None;
        }
        let weights = weights.map(|w| w / sum);
        let depth = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
        Some((depth / self.length, weights))
    }
}
