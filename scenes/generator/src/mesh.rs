//! Meshes as polygons with corners: what the generator builds before it writes OBJ.

use etendue_core::maths::f64 as maths;
use glam::{DAffine3, DVec2, DVec3};
use std::collections::BTreeMap;

/// A corner of a polygon: place in metres and texture coordinate (v up).
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Place in the mesh's frame, m.
    pub position: DVec3,
    /// Texture coordinate.
    pub uv: DVec2,
}

/// A polygon of three or four corners, counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub struct Polygon {
    /// Its corners.
    pub corners: Vec<Corner>,
    /// Its material slot.
    pub slot: usize,
    /// Whether its normals join those of smooth neighbours.
    pub smooth: bool,
}

impl Polygon {
    /// The normal, its length the polygon's area in m² (Newell's sum).
    #[must_use]
    pub fn area_normal(&self) -> DVec3 {
        let first = self.corners[0].position;
        let edges = self.corners[1..].windows(2);
        edges.map(|w| (w[0].position - first).cross(w[1].position - first)).sum::<DVec3>() * 0.5
    }
}

/// Polygons and the names of their material slots.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Names of the material slots, in order.
    pub slots: Vec<&'static str>,
    /// The polygons.
    pub polygons: Vec<Polygon>,
}

/// The edge between two faces stays sharp where their normals part by more than about 38°.
const CREASE_COS: f64 = 0.79;

/// Faces below this area, m², are left out.
const MIN_AREA_M2: f64 = 1e-7;

impl Mesh {
    /// The slot of this name, made when new.
    pub fn slot(&mut self, name: &'static str) -> usize {
        let known = self.slots.iter().position(|slot| *slot == name);
        known.unwrap_or_else(|| {
            self.slots.push(name);
            self.slots.len() - 1
        })
    }

    /// How many triangles the polygons make.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.polygons.iter().map(|polygon| polygon.corners.len() - 2).sum()
    }

    /// A flat polygon without texture.
    pub fn flat(&mut self, slot: &'static str, points: &[DVec3]) {
        self.push(slot, points.iter().map(|&position| Corner { position, uv: DVec2::ZERO }).collect(), false);
    }

    /// A smooth polygon without texture.
    pub fn smooth(&mut self, slot: &'static str, points: &[DVec3]) {
        self.push(slot, points.iter().map(|&position| Corner { position, uv: DVec2::ZERO }).collect(), true);
    }

    /// A flat polygon with texture coordinates.
    pub fn textured(&mut self, slot: &'static str, corners: &[(DVec3, DVec2)]) {
        self.push(slot, corners.iter().map(|&(position, uv)| Corner { position, uv }).collect(), false);
    }

    /// A polygon; corners that coincide are joined and slivers without area left out.
    pub fn push(&mut self, slot: &'static str, mut corners: Vec<Corner>, smooth: bool) {
        corners.dedup_by(|a, b| key(a.position) == key(b.position));
        while corners.len() > 1 && key(corners[0].position) == key(corners[corners.len() - 1].position) {
            corners.pop();
        }
        if corners.len() < 3 {
            return;
        }
        let slot = self.slot(slot);
        for corners in flattened(corners) {
            let polygon = Polygon { corners, slot, smooth };
            if polygon.area_normal().length() > MIN_AREA_M2 {
                self.polygons.push(polygon);
            }
        }
    }

    /// An axis-parallel box seen from outside.
    pub fn block(&mut self, slot: &'static str, low: DVec3, high: DVec3) {
        for axis in 0..3 {
            self.block_side(slot, low, high, axis, false);
            self.block_side(slot, low, high, axis, true);
        }
    }

    /// One side of an axis-parallel box, facing outward.
    pub fn block_side(&mut self, slot: &'static str, low: DVec3, high: DVec3, axis: usize, upper: bool) {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[s, t]| {
            let mut p = low;
            p[axis] = if upper { high[axis] } else { low[axis] };
            p[b] = low[b] + s * (high[b] - low[b]);
            p[c] = low[c] + t * (high[c] - low[c]);
            p
        });
        if !upper {
            points.reverse();
        }
        self.flat(slot, &points);
    }

    /// Another mesh placed into this one. A mirroring placement turns the winding round.
    pub fn add(&mut self, other: &Self, place: DAffine3) {
        let mirrored = place.matrix3.determinant() < 0.0;
        for polygon in &other.polygons {
            let mut corners = polygon.corners.clone();
            for corner in &mut corners {
                corner.position = place.transform_point3(corner.position);
            }
            if mirrored {
                corners.reverse();
            }
            self.push(other.slots[polygon.slot], corners, polygon.smooth);
        }
    }

    /// A surface through rings of points. Rings follow each other along the direction d, points run so that
    /// (ring direction) × d points outward. `slot` names the material of cell (ring, point).
    pub fn loft(&mut self, rings: &[Vec<DVec3>], slot: impl Fn(usize, usize) -> &'static str) {
        for (i, pair) in rings.windows(2).enumerate() {
            for j in 0..pair[0].len() - 1 {
                self.smooth(slot(i, j), &[pair[0][j], pair[0][j + 1], pair[1][j + 1], pair[1][j]]);
            }
        }
    }

    /// A round surface about an axis through `base`: `profile` lists (along the axis, radius) in m.
    pub fn lathe(&mut self, slot: &'static str, frame: DAffine3, profile: &[[f64; 2]], segments: usize) {
        let ring = |[along, radius]: [f64; 2]| -> Vec<DVec3> {
            circle(segments).map(|[c, s]| frame.transform_point3(DVec3::new(radius * c, radius * s, along))).collect()
        };
        let rings: Vec<_> = profile.iter().map(|&knot| ring(knot)).collect();
        self.loft(&rings, |_, _| slot);
    }

    /// A tapered tube along a line of (centre, radius), without ends.
    pub fn tube(&mut self, slot: &'static str, line: &[(DVec3, f64)], segments: usize) {
        let rings: Vec<_> = (0..line.len()).map(|i| tube_ring(line, i, segments)).collect();
        self.loft(&rings, |_, _| slot);
    }

    /// The normal of every corner of every polygon: smooth polygons average their smooth neighbours within the crease
    /// angle, weighted by area.
    #[must_use]
    pub fn corner_normals(&self) -> Vec<Vec<DVec3>> {
        let area_normals: Vec<DVec3> = self.polygons.iter().map(Polygon::area_normal).collect();
        let around = self.smooth_neighbours();
        let normal = |index: usize, corner: &Corner| {
            let own = area_normals[index].normalize();
            if !self.polygons[index].smooth {
                return own;
            }
            let near = around[&key(corner.position)].iter().map(|&other| area_normals[other]);
            near.filter(|other| other.normalize().dot(own) > CREASE_COS).sum::<DVec3>().normalize()
        };
        let polygons = self.polygons.iter().enumerate();
        polygons.map(|(index, polygon)| polygon.corners.iter().map(|corner| normal(index, corner)).collect()).collect()
    }

    fn smooth_neighbours(&self) -> BTreeMap<[i64; 3], Vec<usize>> {
        let mut around: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        for (index, polygon) in self.polygons.iter().enumerate().filter(|(_, polygon)| polygon.smooth) {
            for corner in &polygon.corners {
                around.entry(key(corner.position)).or_default().push(index);
            }
        }
        around
    }

    /// The lowest and highest corner of the box about the mesh, m.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let points = || self.polygons.iter().flat_map(|polygon| &polygon.corners).map(|corner| corner.position);
        (points().fold(DVec3::INFINITY, DVec3::min), points().fold(DVec3::NEG_INFINITY, DVec3::max))
    }
}

/// A four-sided polygon that is bent or not convex becomes two triangles along its shorter diagonal.
fn flattened(corners: Vec<Corner>) -> Vec<Vec<Corner>> {
    if corners.len() != 4 {
        return vec![corners];
    }
    let p = |i: usize| corners[i % 4].position;
    let turn = |i: usize| (p(i + 1) - p(i)).cross(p(i + 3) - p(i)).normalize_or_zero();
    if (0..4).all(|i| turn(i).dot(turn(i + 1)) > 0.95) {
        return vec![corners];
    }
    let first = usize::from((p(2) - p(0)).length() > (p(3) - p(1)).length());
    let at = |i: usize| corners[(first + i) % 4];
    vec![vec![at(0), at(1), at(2)], vec![at(0), at(2), at(3)]]
}

/// The place as whole millimetres: what the OBJ file holds.
#[must_use]
pub fn key(position: DVec3) -> [i64; 3] {
    position.to_array().map(|x| (x * 1000.0).round() as i64)
}

/// (cos, sin) of points once round, the first repeated at the end.
pub fn circle(segments: usize) -> impl Iterator<Item = [f64; 2]> {
    (0..=segments).map(move |i| {
        let (s, c) = maths::sin_cos((i % segments) as f64 / segments as f64 * core::f64::consts::TAU);
        [c, s]
    })
}

/// A frame at `base` whose z axis is `axis`.
#[must_use]
pub fn along(base: DVec3, axis: DVec3) -> DAffine3 {
    let z = axis.normalize();
    let helper = if z.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    let y = z.cross(helper).normalize();
    DAffine3 { matrix3: glam::DMat3::from_cols(y.cross(z), y, z), translation: base }
}

fn tube_ring(line: &[(DVec3, f64)], i: usize, segments: usize) -> Vec<DVec3> {
    let (before, after) = (line[i.saturating_sub(1)].0, line[(i + 1).min(line.len() - 1)].0);
    let frame = along(line[i].0, after - before);
    circle(segments).map(|[c, s]| frame.transform_point3(DVec3::new(line[i].1 * c, line[i].1 * s, 0.0))).collect()
}

/// A turn about z by `yaw_deg`, then a shift.
#[must_use]
pub fn place(yaw_deg: f64, shift: DVec3) -> DAffine3 {
    let (s, c) = maths::sin_cos(yaw_deg.to_radians());
    DAffine3 {
        matrix3: glam::DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z),
        translation: shift,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The divergence theorem: Σ p·n A / 3 over a closed surface is its volume when it faces outward.
    fn volume_m3(mesh: &Mesh) -> f64 {
        let part = |polygon: &Polygon| polygon.area_normal().dot(polygon.corners[0].position) / 3.0;
        mesh.polygons.iter().map(part).sum()
    }

    #[test]
    fn a_block_faces_outward() {
        let mut mesh = Mesh::default();
        mesh.block("a", DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 4.0, 6.0));
        assert!((volume_m3(&mesh) - 6.0).abs() < 1e-12, "{}", volume_m3(&mesh));
    }

    #[test]
    fn a_lathe_faces_outward() {
        let mut mesh = Mesh::default();
        let profile = [[0.0, 0.0], [0.0, 1.0], [2.0, 1.0], [2.0, 0.0]];
        mesh.lathe("a", DAffine3::IDENTITY, &profile, 400);
        // A 400-gon's area falls short of the circle's by 2π²/(3·400²) = 4e-5.
        assert!((volume_m3(&mesh) / core::f64::consts::TAU - 1.0).abs() < 1e-4, "{}", volume_m3(&mesh));
    }

    #[test]
    fn mirrored_meshes_keep_facing_outward() {
        let mut block = Mesh::default();
        block.block("a", DVec3::ZERO, DVec3::ONE);
        let mut mesh = Mesh::default();
        mesh.add(&block, DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)));
        assert!((volume_m3(&mesh) - 1.0).abs() < 1e-12);
    }
}
