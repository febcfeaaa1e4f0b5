//! Texture coordinates from positions: planar, spherical and cylindrical mappings of pbrt, at the vertices of a mesh.
//!
//! The planar mapping is exact. The others are not linear over a triangle, so triangles are divided until their corners are at most 2° apart, and the seam and
//! the poles get coordinates of their own.

use std::f64::consts::{PI, TAU};

use etendue_core::maths::f64 as maths;
use glam::{DAffine3, DVec3};

use super::round::Triangles;

/// Source of the texture coordinates that place an image.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TextureBase {
    /// Those of the surface.
    Surface,
    /// Those of a projection.
    Projection(TextureProjection),
}

/// Mapping of positions to texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TextureProjection {
    /// Transform from the file's world to the space of the texture.
    pub(crate) to_texture: DAffine3,
    pub(crate) kind: ProjectionKind,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ProjectionKind {
    /// Dot products with two vectors.
    Planar { s: DVec3, t: DVec3 },
    /// Angle from +z over π, and azimuth from +x towards +y over 2π, from 0 to 1.
    Spherical,
    /// Azimuth from −x towards −y over 2π, from 0 to 1, and z.
    Cylindrical,
}

/// Angle between the corners of a triangle below which it is not divided.
const MAX_ANGLE_COS: f64 = 0.999_39;
/// Divisions of one triangle in a row, and triangles of a mesh, above which none is divided.
const MAX_DIVISIONS: u32 = 16;
const MAX_TRIANGLES: usize = 400_000;

impl TextureProjection {
    fn is_planar(&self) -> bool {
        matches!(self.kind, ProjectionKind::Planar { .. })
    }

    /// Texture coordinates of a point in the space of the texture.
    fn coordinates(&self, p: DVec3) -> [f64; 2] {
        match &self.kind {
            ProjectionKind::Planar { s, t } => [p.dot(*s), p.dot(*t)],
            ProjectionKind::Spherical => {
                let polar = maths::atan2(p.truncate().length(), p.z) / PI;
                [polar, (maths::atan2(p.y, p.x) / TAU).rem_euclid(1.0)]
            }
            ProjectionKind::Cylindrical => [(PI + maths::atan2(p.y, p.x)) / TAU, p.z],
        }
    }

    /// Coordinates of three corners on one side of the seam; a corner on the axis has the mean azimuth of the others.
    fn corners(&self, points: [DVec3; 3]) -> [[f64; 2]; 3] {
        let mut corners = points.map(|p| self.coordinates(p));
        let turn = match self.kind {
            ProjectionKind::Planar { .. } => return corners,
            ProjectionKind::Spherical => 1,
            ProjectionKind::Cylindrical => 0,
        };
        let on_axis = points.map(|p| p.truncate().length() <= 1e-9 * p.length());
        let largest = (0..3).filter(|i| !on_axis[*i]).map(|i| corners[i][turn]).fold(0.0, f64::max);
        for i in (0..3).filter(|i| !on_axis[*i]) {
            if largest - corners[i][turn] > 0.5 {
                corners[i][turn] += 1.0;
            }
        }
        let others: Vec<f64> = (0..3).filter(|i| !on_axis[*i]).map(|i| corners[i][turn]).collect();
        for i in (0..3).filter(|i| on_axis[*i]) {
            corners[i][turn] = others.iter().sum::<f64>() / others.len().max(1) as f64;
        }
        corners
    }

    /// Returns true if a triangle is small as seen from the axis or the centre.
    fn is_small(&self, points: [DVec3; 3]) -> bool {
        let direction = |p: DVec3| match self.kind {
            ProjectionKind::Cylindrical => DVec3::new(p.x, p.y, 0.0).normalize_or_zero(),
            _ => p.normalize_or_zero(),
        };
        let [a, b, c] = points.map(direction);
        [a.dot(b), b.dot(c), c.dot(a)].iter().all(|cos| *cos > MAX_ANGLE_COS)
    }
}

/// Corner of a divided triangle.
#[derive(Clone, Copy)]
struct Corner {
    position: DVec3,
    normal: DVec3,
}

impl Corner {
    fn between(self, other: Self) -> Self {
        let normal = (self.normal + other.normal).normalize_or(self.normal);
        Self { position: 0.5 * (self.position + other.position), normal }
    }
}

impl Triangles {
    /// The same surface with the texture coordinates of a projection; `to_world` is its transform to the file's world.
    pub(crate) fn with_projected_uvs(self, projection: &TextureProjection, to_world: DAffine3) -> Self {
        let to_texture = projection.to_texture * to_world;
        if projection.is_planar() {
            let uv = |p: &[f64; 3]| projection.coordinates(to_texture.transform_point3(DVec3::from_array(*p)));
            return Self { uvs: self.positions.iter().map(uv).collect(), ..self };
        }
        let mut mesh = Self::default();
        let corner = |i: u32| Corner {
            position: DVec3::from_array(self.positions[i as usize]),
            normal: self.normals.get(i as usize).map_or(DVec3::ZERO, |n| DVec3::from_array(*n)),
        };
        let mut waiting: Vec<(u32, [Corner; 3])> = self.triangles.iter().rev().map(|t| (0, t.map(corner))).collect();
        while let Some((divisions, corners)) = waiting.pop() {
            let points = corners.map(|c| to_texture.transform_point3(c.position));
            let is_final = divisions >= MAX_DIVISIONS || mesh.triangles.len() + waiting.len() > MAX_TRIANGLES;
            if is_final || projection.is_small(points) {
                mesh.push(corners, projection.corners(points), !self.normals.is_empty());
                continue;
            }
            // The longest side is halved.
            let [a, b, c] = [0, 1, 2].map(|i| points[i].distance_squared(points[(i + 1) % 3]));
            let first = if a >= b && a >= c { 0 } else { usize::from(b < c) + 1 };
            let [p, q, r] = [0, 1, 2].map(|i| corners[(first + i) % 3]);
            let middle = p.between(q);
            waiting.push((divisions + 1, [p, middle, r]));
            waiting.push((divisions + 1, [middle, q, r]));
        }
        mesh
    }

    fn push(&mut self, corners: [Corner; 3], uvs: [[f64; 2]; 3], has_normals: bool) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners.map(|c| c.position.to_array()));
        if has_normals {
            self.normals.extend(corners.map(|c| c.normal.to_array()));
        }
        self.uvs.extend(uvs);
        self.triangles.push([first, first + 1, first + 2]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projection(kind: ProjectionKind) -> TextureProjection {
        TextureProjection { to_texture: DAffine3::IDENTITY, kind }
    }

    #[test]
    fn points_have_the_coordinates_of_pbrt() {
        let near = |kind: ProjectionKind, p: [f64; 3], expected: [f64; 2]| {
            let actual = projection(kind).coordinates(DVec3::from_array(p));
            assert!((0..2).all(|i| (actual[i] - expected[i]).abs() < 1e-12), "{p:?}: {actual:?}");
        };
        near(ProjectionKind::Spherical, [0.0, 0.0, 3.0], [0.0, 0.0]);
        near(ProjectionKind::Spherical, [0.0, 2.0, 0.0], [0.5, 0.25]);
        near(ProjectionKind::Spherical, [0.0, -2.0, 0.0], [0.5, 0.75]);
        near(ProjectionKind::Cylindrical, [1.0, 0.0, 7.0], [0.5, 7.0]);
        near(ProjectionKind::Cylindrical, [0.0, 1.0, -1.0], [0.75, -1.0]);
        near(ProjectionKind::Planar { s: DVec3::X, t: DVec3::new(0.0, 0.0, 2.0) }, [1.0, 5.0, 3.0], [1.0, 6.0]);
    }

    /// A large triangle across the seam: every part is small, none spans the seam, and the area stays.
    #[test]
    fn triangles_are_divided_at_the_seam() {
        let positions = vec![[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, 0.0, -1.5]];
        let mesh = Triangles { positions, triangles: vec![[0, 1, 2]], ..Triangles::default() };
        let area = |mesh: &Triangles| -> f64 {
            let at = |i: u32| DVec3::from_array(mesh.positions[i as usize]);
            mesh.triangles.iter().map(|[a, b, c]| 0.5 * (at(*b) - at(*a)).cross(at(*c) - at(*a)).length()).sum()
        };
        let before = area(&mesh);
        let divided = mesh.with_projected_uvs(&projection(ProjectionKind::Cylindrical), DAffine3::IDENTITY);
        assert!(divided.triangles.len() > 100 && (area(&divided) / before - 1.0).abs() < 1e-12);
        let spans = divided.triangles.iter().map(|t| {
            let turns = t.map(|i| divided.uvs[i as usize][0]);
            turns.iter().fold(0.0, |m: f64, v| m.max(*v)) - turns.iter().fold(2.0, |m: f64, v| m.min(*v))
        });
        assert!(spans.fold(0.0, f64::max) < 0.5);
    }
}
