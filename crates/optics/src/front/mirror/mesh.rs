//! A mirror by triangles, with smooth normals.
//!
//! A ray meets the flat triangles, but is reflected by the normal interpolated between their corners (Phong 1975), so that the
//! picture has no facets: directions err by the square of the triangles' size. The test of a ray and a triangle is that of
//! Woop, Benthin and Wald ("Watertight ray/triangle intersection", 2013) in double precision: a shared edge has one sign for
//! both sides and belongs to both, so nothing leaks between.

use super::super::Line;
use super::Touch;
use super::tree::Tree;
use crate::error::FrontError;
use core::fmt;
use glam::DVec3;

/// A mesh.
#[derive(Clone, PartialEq)]
pub struct MeshMirror {
    positions_mm: Vec<DVec3>,
    normals: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    tree: Tree,
}

impl fmt::Debug for MeshMirror {
    /// Every vertex, normal and triangle: what decides its pictures.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MeshMirror({:?}, {:?}, {:?})", self.positions_mm, self.normals, self.triangles)
    }
}

impl MeshMirror {
    /// A mesh of corners (mm) in its own frame and triangles, counter-clockwise as seen from the reflecting side. Without
    /// normals, each corner has the mean normal of its triangles, weighted by their areas.
    ///
    /// # Errors
    /// Where it has no triangles, one names a corner that is not there, has no area, or numbers are not finite.
    pub fn new(positions_mm: Vec<DVec3>, normals: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, FrontError> {
        let refuse = |what| Err(FrontError::Mesh { what });
        if triangles.is_empty() {
            return refuse("no triangles");
        }
        if triangles.iter().flatten().any(|i| *i as usize >= positions_mm.len()) {
            return refuse("a triangle with a corner that is not there");
        }
        if !positions_mm.iter().all(|p| p.is_finite()) {
            return refuse("a corner that is not at a finite position");
        }
        if triangles.iter().any(|t| area_normal(&positions_mm, t) == DVec3::ZERO) {
            return refuse("a triangle without area");
        }
        let normals = if normals.is_empty() { smooth(&positions_mm, &triangles) } else { normals };
        if normals.len() != positions_mm.len() {
            return refuse("normals that are not one a corner");
        }
        let normals: Option<Vec<DVec3>> = normals.into_iter().map(DVec3::try_normalize).collect();
        let Some(normals) = normals else { return refuse("a corner without a normal") };
        let tree = Tree::new(&positions_mm, &triangles);
        Ok(Self { positions_mm, normals, triangles, tree })
    }

    /// How many triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are none, which cannot be.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The first point that a ray of its frame meets.
    pub(super) fn touch(&self, line: &Line) -> Option<Touch> {
        let shear = Shear::of(line);
        let (mut nearest, mut found) = (f64::INFINITY, None);
        self.tree.visit(line, &mut nearest, |index, nearest| {
            let corners = self.triangles[index as usize].map(|i| self.positions_mm[i as usize]);
            if let Some((t, weights)) = shear.hit(corners).filter(|(t, _)| *t > 0.0 && *t < *nearest) {
                (*nearest, found) = (t, Some((index, weights)));
            }
        });
        let (index, weights) = found?;
        Some(self.at(index, weights))
    }

    fn at(&self, index: u32, weights: [f64; 3]) -> Touch {
        let triangle = &self.triangles[index as usize];
        let mix = |of: &[DVec3]| -> DVec3 { triangle.iter().zip(weights).map(|(i, w)| of[*i as usize] * w).sum() };
        let facing = area_normal(&self.positions_mm, triangle).normalize();
        let normal = mix(&self.normals).try_normalize().unwrap_or(facing);
        Touch { point_mm: mix(&self.positions_mm), facing, normal }
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
    // A corner of no triangle is never met.
    normals.into_iter().map(|n| if n == DVec3::ZERO { DVec3::Z } else { n }).collect()
}

/// The frame in which a ray runs along its longest axis.
struct Shear {
    origin: DVec3,
    axes: [usize; 3],
    slope: [f64; 2],
    length: f64,
}

impl Shear {
    fn of(line: &Line) -> Self {
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
