//! Round shapes as meshes, for textured or partial shapes: their texture coordinates are then those of the source program.

use std::{f64::consts::TAU, path::Path};

use etendue_core::maths::f64 as maths;
use etendue_io::mesh::{PlacedTriangles, read_mesh};
use glam::{DAffine3, DVec3};

/// Segments of a full turn about the axis: their chords lie within 7.5e-5 of the radius.
const SIDES: u32 = 256;
/// Segments of the angle from pole to pole.
const RINGS: u32 = 128;

/// Point of a surface.
pub(crate) struct VertexPoint {
    pub(crate) position: DVec3,
    /// Unit normal.
    pub(crate) normal: DVec3,
    /// Texture coordinates; v points upwards in images.
    pub(crate) uv: [f64; 2],
}

impl Triangles {
    /// Surface over the unit square, which `point` evaluates at (s, t); triangles of zero area are omitted.
    fn over_square(columns: u32, rows: u32, point: impl Fn(f64, f64) -> VertexPoint) -> Self {
        let mut mesh = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let VertexPoint { position, normal, uv } =
                    point(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
                mesh.positions.push(position.to_array());
                mesh.normals.push(normal.to_array());
                mesh.uvs.push(uv);
            }
        }
        let at = |row: u32, column: u32| row * (columns + 1) + column;
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
            for corners in [[a, b, d], [a, d, c]] {
                if mesh.has_area(corners) {
                    mesh.triangles.push(corners);
                }
            }
        }
        mesh
    }

    fn has_area(&self, corners: [u32; 3]) -> bool {
        let [a, b, c] = corners.map(|i| DVec3::from_array(self.positions[i as usize]));
        let longest = [a.distance(b), b.distance(c), c.distance(a)].into_iter().fold(0.0, f64::max);
        (b - a).cross(c - a).length() > 1e-12 * longest * longest
    }

    /// Part of a sphere about the origin between two heights z, over `turn_rad` from +x towards +y. u is the fraction of the turn, v that of the angle from the
    /// lower to the upper border. (Mitsuba's whole sphere has the same.)
    pub(crate) fn from_sphere(radius: f64, [low, high]: [f64; 2], turn_rad: f64) -> Self {
        let polar = |z: f64| maths::acos((z / radius).clamp(-1.0, 1.0));
        let (from, to) = (polar(low), polar(high));
        Self::over_square(SIDES, RINGS, |s, t| {
            let (sin, cos) = maths::sin_cos(from + (to - from) * t);
            let around = around(s * turn_rad);
            let normal = DVec3::new(sin * around.x, sin * around.y, cos);
            VertexPoint { position: radius * normal, normal, uv: [s, t] }
        })
    }

    /// Lateral surface of a cylinder about z between two heights, over `turn_rad` from +x towards +y. u is the fraction of the turn, v that of the height.
    pub(crate) fn from_cylinder(radius: f64, [low, high]: [f64; 2], turn_rad: f64) -> Self {
        Self::over_square(SIDES, 1, |s, t| {
            let normal = around(s * turn_rad);
            VertexPoint { position: radius * normal + DVec3::Z * (low + (high - low) * t), normal, uv: [s, t] }
        })
    }

    /// Ring between an outer and an inner radius (0: a disc) in the plane z = `height`, with its front towards +z, over `turn_rad` from +x towards +y. `uv`
    /// gives the texture coordinates at the fractions of the turn and of the distance from the outer border to the inner.
    pub(crate) fn from_ring(
        [outer, inner]: [f64; 2],
        height: f64,
        turn_rad: f64,
        uv: impl Fn(f64, f64) -> [f64; 2],
    ) -> Self {
        // One row would interpolate a texture linearly across triangles that meet in the centre.
        Self::over_square(SIDES, RINGS, |s, t| {
            let position = around(s * turn_rad) * (outer + (inner - outer) * t) + DVec3::Z * height;
            VertexPoint { position, normal: DVec3::Z, uv: uv(s, t) }
        })
    }

    /// The same triangles with separate vertices and pbrt's default texture coordinates: those of the corners of each.
    pub(crate) fn with_corners_as_uv(self) -> Self {
        let corners = self.triangles.iter().flatten().map(|i| *i as usize);
        let take = |list: &[[f64; 3]]| match list.is_empty() {
            true => Vec::new(),
            false => corners.clone().map(|i| list[i]).collect(),
        };
        Self {
            positions: take(&self.positions),
            normals: take(&self.normals),
            uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].repeat(self.triangles.len()),
            triangles: (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        }
    }
}

/// Unit vector at this angle from +x towards +y; exact after whole turns.
fn around(angle_rad: f64) -> DVec3 {
    let (sin, cos) = maths::sin_cos(if angle_rad >= TAU { 0.0 } else { angle_rad });
    DVec3::new(cos, sin, 0.0)
}

/// Triangles of a file.
#[derive(Clone, Default)]
pub(crate) struct Triangles {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) uvs: Vec<[f64; 2]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Triangles {
    /// Triangles of a mesh file, with texture coordinates whose v points upwards in images.
    pub(crate) fn read(file: &Path) -> Result<Self, String> {
        let asset = read_mesh(file).map_err(|e| e.to_string())?;
        let place = |p: &[f32; 3]| std::array::from_fn(|i| asset.origin[i] + f64::from(p[i]));
        Ok(Self {
            positions: asset.positions.iter().map(place).collect(),
            normals: asset.normals.iter().map(|n| n.map(f64::from)).collect(),
            uvs: asset.uvs.iter().map(|uv| uv.map(f64::from)).collect(),
            triangles: asset.triangles,
        })
    }

    /// Gives every vertex the mean normal of its triangles, weighted by angle (Thürmer and Wüthrich 1998), as Mitsuba does. The triangles are those in the
    /// file's world, whose front a mirror reverses.
    pub(crate) fn smooth(&mut self, to_world: DAffine3) {
        let at = |i: u32| to_world.transform_point3(DVec3::from_array(self.positions[i as usize]));
        // Inverse of `placed`: normals transform by the inverse transpose.
        let back = to_world.matrix3.transpose();
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for [a, b, c] in self.triangles.iter().copied() {
            let normal = (at(b) - at(a)).cross(at(c) - at(a)).normalize_or_zero();
            for [here, next, last] in [[a, b, c], [b, c, a], [c, a, b]] {
                let [u, v] = [at(next) - at(here), at(last) - at(here)].map(DVec3::normalize_or_zero);
                sums[here as usize] += maths::atan2(u.cross(v).length(), u.dot(v)) * normal;
            }
        }
        self.normals = sums.into_iter().map(|sum| (back * sum.normalize_or(DVec3::Z)).to_array()).collect();
    }

    /// The same triangles in our world. Winding follows the normal, which a mirror does not reverse.
    pub(crate) fn placed(self, to_ours: DAffine3, reversed: bool) -> PlacedTriangles {
        let inverse = to_ours.matrix3.inverse().transpose();
        let side = if reversed { -1.0 } else { 1.0 };
        let positions: Vec<DVec3> =
            self.positions.iter().map(|p| to_ours.transform_point3(DVec3::from_array(*p))).collect();
        let normals: Vec<DVec3> =
            self.normals.iter().map(|n| (inverse * DVec3::from_array(*n)).normalize_or_zero() * side).collect();
        let turned = (to_ours.matrix3.determinant() < 0.0) != reversed;
        let wind = |[a, b, c]: [u32; 3]| {
            let facing = |[a, b, c]: [usize; 3]| (positions[b] - positions[a]).cross(positions[c] - positions[a]);
            let own = [a, b, c].map(|i| i as usize);
            let turn = match normals.is_empty() {
                true => turned,
                false => own.iter().map(|i| normals[*i]).sum::<DVec3>().dot(facing(own)) < 0.0,
            };
            if turn { [a, c, b] } else { [a, b, c] }
        };
        PlacedTriangles {
            triangles: self.triangles.into_iter().map(wind).collect(),
            normals: normals.iter().map(|n| n.to_array()).collect(),
            uvs: self.uvs,
            positions: positions.iter().map(|p| p.to_array()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(mesh: &Triangles) -> f64 {
        let at = |i: u32| DVec3::from_array(mesh.positions[i as usize]);
        mesh.triangles.iter().map(|[a, b, c]| 0.5 * (at(*b) - at(*a)).cross(at(*c) - at(*a)).length()).sum()
    }

    /// Areas of zones (Archimedes), lateral surfaces and rings; chords lose 1e-4 of them.
    #[test]
    fn parts_have_their_areas() {
        let parts = [
            (Triangles::from_sphere(2.0, [-2.0, 2.0], TAU), 2.0 * TAU * 4.0),
            (Triangles::from_sphere(2.0, [-1.0, 0.5], 0.25 * TAU), 0.25 * TAU * 2.0 * 1.5),
            (Triangles::from_cylinder(0.5, [1.0, 4.0], 0.5 * TAU), 0.5 * TAU * 0.5 * 3.0),
            (Triangles::from_ring([3.0, 1.0], 2.0, TAU, |s, t| [s, t]), 0.5 * TAU * 8.0),
            (Triangles::from_ring([3.0, 0.0], 2.0, 0.3 * TAU, |s, t| [s, t]), 0.15 * TAU * 9.0),
        ];
        for (mesh, expected) in parts {
            let actual = area(&mesh);
            assert!((actual / expected - 1.0).abs() < 2e-4, "{actual} for {expected}");
        }
    }

    #[test]
    fn coordinates_of_a_sphere_begin_at_its_south_pole_and_at_x() {
        let ball = Triangles::from_sphere(1.0, [-1.0, 1.0], TAU);
        let find = |at: DVec3| {
            let near = |p: &&([f64; 3], &[f64; 2])| DVec3::from_array(p.0).distance(at) < 1e-9;
            *ball.positions.iter().copied().zip(&ball.uvs).collect::<Vec<_>>().iter().find(near).expect("a vertex").1
        };
        assert_eq!(find(DVec3::X), [0.0, 0.5]);
        assert_eq!(find(DVec3::Y), [0.25, 0.5]);
        assert_eq!((find(DVec3::NEG_Z)[1], find(DVec3::Z)[1]), (0.0, 1.0));
    }

    /// Three squares meet at the corner of a cube, and one of them is cut there: weighted by angle its normal is still the diagonal.
    #[test]
    fn normals_are_weighted_by_angles() {
        let positions = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 0.]];
        let triangles = vec![[0, 4, 1], [0, 2, 4], [0, 1, 3], [0, 3, 2]];
        let mut corner = Triangles { positions, triangles, ..Triangles::default() };
        corner.smooth(DAffine3::IDENTITY);
        let diagonal = -DVec3::ONE.normalize();
        assert!((DVec3::from_array(corner.normals[0]) - diagonal).length() < 1e-12, "{:?}", corner.normals[0]);
    }

    /// A roof of two halves, stretched and mirrored in the world: the ridge's normal is that in the world.
    #[test]
    fn normals_are_those_of_the_place() {
        let positions = vec![[0., 0., 1.], [0., 1., 1.], [1., 0., 0.], [-1., 0., 0.]];
        let mut roof = Triangles { positions, triangles: vec![[0, 2, 1], [0, 1, 3]], ..Triangles::default() };
        let place = DAffine3::from_scale(DVec3::new(3.0, -1.0, 0.5));
        roof.smooth(place);
        let placed = roof.placed(place, false);
        let down = DVec3::from_array(placed.normals[0]);
        assert!((down - DVec3::NEG_Z).length() < 1e-12, "{down}: a mirror turns the front");
        assert_eq!(placed.triangles, [[0, 2, 1], [0, 1, 3]]);
    }
}
