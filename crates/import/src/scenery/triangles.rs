//! Meshes as files have them, and in their places.

use etendue_core::maths::f64 as maths;
use etendue_io::mesh::{PlacedTriangles, read_mesh};
use glam::{DAffine3, DVec3};
use std::path::Path;

/// Triangles as a file has them.
#[derive(Clone, Default)]
pub(crate) struct Triangles {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) uvs: Vec<[f64; 2]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Triangles {
    /// Those of a mesh file, with texture coordinates whose v points upwards in pictures.
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

    /// Gives every vertex the mean normal of its triangles, each by its angle there (Thürmer and Wüthrich 1998), as Mitsuba does: of the triangles as they
    /// lie in the file's world, whose front a mirror turns.
    pub(crate) fn smooth(&mut self, to_world: DAffine3) {
        let at = |i: u32| to_world.transform_point3(DVec3::from_array(self.positions[i as usize]));
        // The way back of `placed`: normals go by the inverse transposed.
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

    /// The same in our world. Winding is that of the normal, which a mirror does not turn.
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

    /// At the corner of a cube three squares meet, of which one is cut there: by angles its normal is the diagonal all the same.
    #[test]
    fn normals_are_weighted_by_angles() {
        let positions = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 0.]];
        let triangles = vec![[0, 4, 1], [0, 2, 4], [0, 1, 3], [0, 3, 2]];
        let mut corner = Triangles { positions, triangles, ..Triangles::default() };
        corner.smooth(DAffine3::IDENTITY);
        let diagonal = -DVec3::ONE.normalize();
        assert!((DVec3::from_array(corner.normals[0]) - diagonal).length() < 1e-12, "{:?}", corner.normals[0]);
    }

    /// A roof of two halves, stretched and mirrored in its place: the ridge's normal is that of the place.
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
