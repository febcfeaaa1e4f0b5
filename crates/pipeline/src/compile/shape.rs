//! Shapes without a file, as meshes.

use core::f64::consts::TAU;
use etendue_core::maths::f64::{sin, sin_cos};
use etendue_tracer::geometry::{DroppedTriangles, Mesh, MeshError};
use glam::{Vec2, Vec3};

/// Corners of a shape's faces, four per face, counter-clockwise as seen from the front.
pub(super) struct FaceCorners(Vec<[Vec3; 4]>);

/// A rectangle in the plane z = 0, centred, its front towards +z; u along x, v along y.
pub(super) fn quad([x, y]: [f64; 2]) -> FaceCorners {
    let (x, y) = (x as f32 / 2.0, y as f32 / 2.0);
    let corner = |u: f32, v: f32| Vec3::new(u * x, v * y, 0.0);
    FaceCorners(vec![[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]])
}

/// A cuboid, centred, its faces outward.
pub(super) fn cuboid(size_m: [f64; 3]) -> FaceCorners {
    let half = Vec3::from(size_m.map(|s| s as f32)) / 2.0;
    let axes = [(Vec3::X, Vec3::Y, Vec3::Z), (Vec3::Y, Vec3::Z, Vec3::X), (Vec3::Z, Vec3::X, Vec3::Y)];
    let faces = axes.into_iter().flat_map(|(n, s, t)| [(n, s, t), (-n, t, s)]);
    let face = |(n, s, t): (Vec3, Vec3, Vec3)| [n - s - t, n + s - t, n + s + t, n - s + t].map(|c| c * half);
    FaceCorners(faces.map(face).collect())
}

/// Number of sides of the polygon that approximates a disc.
const DISC_SIDES: u32 = 256;

/// A disc in the plane z = 0, centred, its front towards +z, as a regular polygon of the same area.
pub(super) fn disc(radius_m: f64) -> Result<(Mesh, DroppedTriangles), MeshError> {
    let step = TAU / f64::from(DISC_SIDES);
    let reach = (step / sin(step)).sqrt();
    let circle = (0..DISC_SIDES).map(|i| {
        let (y, x) = sin_cos(f64::from(i) * step);
        Vec2::new(x as f32, y as f32)
    });
    let unit: Vec<Vec2> = core::iter::once(Vec2::ZERO).chain(circle).collect();
    let positions = unit.iter().map(|p| (*p * (radius_m * reach) as f32).extend(0.0)).collect();
    let uvs = unit.iter().map(|p| 0.5 + 0.5 * *p).collect();
    let triangles = (0..DISC_SIDES).map(|i| [0, 1 + i, 1 + (i + 1) % DISC_SIDES]).collect();
    Mesh::new(positions, vec![], uvs, triangles, vec![])
}

impl FaceCorners {
    /// Mesh in which faces share no vertices, so that each has its own texture coordinates, 0 to 1.
    pub(super) fn into_mesh(self) -> Result<(Mesh, DroppedTriangles), MeshError> {
        let faces = self.0.len() as u32;
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].repeat(self.0.len());
        let triangles = (0..faces).flat_map(|f| [[4 * f, 4 * f + 1, 4 * f + 2], [4 * f, 4 * f + 2, 4 * f + 3]]);
        Mesh::new(self.0.into_flattened(), vec![], uvs, triangles.collect(), vec![])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normals(corners: &FaceCorners) -> Vec<Vec3> {
        corners.0.iter().map(|[a, b, c, _]| (*b - *a).cross(*c - *a).normalize()).collect()
    }

    #[test]
    fn a_disc_has_the_area_of_the_circle_and_faces_up() {
        let (mesh, dropped_triangles) = disc(0.3).expect("a mesh");
        assert_eq!((mesh.triangles().len(), dropped_triangles), (256, DroppedTriangles::default()));
        let twice_area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
            f64::from((b - a).cross(c - a).z)
        };
        let area: f64 = mesh.triangles().iter().map(twice_area).sum::<f64>() / 2.0;
        // f32 positions.
        assert!((area / (core::f64::consts::PI * 0.09) - 1.0).abs() < 1e-6, "{area}");
    }

    #[test]
    fn a_quad_faces_up_and_a_cuboid_outward() {
        assert_eq!(normals(&quad([2.0, 3.0])), [Vec3::Z]);
        let cuboid = cuboid([1.0, 2.0, 4.0]);
        for (corners, normal) in cuboid.0.iter().zip(normals(&cuboid)) {
            let centre = corners.iter().sum::<Vec3>() / 4.0;
            assert!(centre.normalize().dot(normal) > 1.0 - 1e-6);
        }
        let (mesh, dropped_triangles) = cuboid.into_mesh().expect("a mesh");
        assert_eq!((mesh.triangles().len(), dropped_triangles), (12, DroppedTriangles::default()));
        assert_eq!(mesh.bounds(), Some((Vec3::new(-0.5, -1.0, -2.0), Vec3::new(0.5, 1.0, 2.0))));
    }
}
