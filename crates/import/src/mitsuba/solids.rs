//! Shapes that Mitsuba knows, as meshes with the texture coordinates that it gives them; v points upwards in pictures, as ours does.

use crate::scenery::Triangles;
use etendue_core::maths::f64 as maths;
use glam::DVec3;
use std::f64::consts::TAU;

/// Two triangles of every four corners.
fn squares(count: u32) -> Vec<[u32; 3]> {
    (0..count).map(|i| 4 * i).flat_map(|i| [[i, i + 1, i + 2], [i, i + 2, i + 3]]).collect()
}

/// The square −1 … 1 in z = 0, its front towards +z.
pub(super) fn rectangle() -> Triangles {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Triangles {
        positions: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        // v is 0 at y = −1, where the first row of a picture lies.
        uvs: corners.map(|[x, y]| [0.5 * (x + 1.0), 0.5 * (1.0 - y)]).to_vec(),
        triangles: squares(1),
    }
}

/// The cube −1 … 1. Corners in the order of Mitsuba's.
pub(super) fn cube() -> Triangles {
    let faces: [([f64; 3], [[f64; 3]; 4]); 6] = [
        ([0., -1., 0.], [[1., -1., -1.], [1., -1., 1.], [-1., -1., 1.], [-1., -1., -1.]]),
        ([0., 1., 0.], [[1., 1., -1.], [-1., 1., -1.], [-1., 1., 1.], [1., 1., 1.]]),
        ([1., 0., 0.], [[1., -1., -1.], [1., 1., -1.], [1., 1., 1.], [1., -1., 1.]]),
        ([0., 0., 1.], [[1., -1., 1.], [1., 1., 1.], [-1., 1., 1.], [-1., -1., 1.]]),
        ([-1., 0., 0.], [[-1., -1., 1.], [-1., 1., 1.], [-1., 1., -1.], [-1., -1., -1.]]),
        ([0., 0., -1.], [[1., 1., -1.], [1., -1., -1.], [-1., -1., -1.], [-1., 1., -1.]]),
    ];
    Triangles {
        positions: faces.iter().flat_map(|(_, corners)| *corners).collect(),
        normals: faces.iter().flat_map(|(normal, _)| [*normal; 4]).collect(),
        uvs: [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].repeat(6),
        triangles: squares(6),
    }
}

/// The side of a cylinder without its ends; `None` of one without extent.
pub(super) fn cylinder([from, to]: [DVec3; 2], radius: f64) -> Option<Triangles> {
    const SIDES: u32 = 128;
    let axis = (to - from).try_normalize().filter(|_| radius > 0.0)?;
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let mut made = Triangles::default();
    for i in 0..=SIDES {
        let share = f64::from(i) / f64::from(SIDES);
        let (sin, cos) = maths::sin_cos(share * TAU);
        let out = cos * x + sin * y;
        for (end, v) in [(from, 1.0), (to, 0.0)] {
            made.positions.push((end + radius * out).to_array());
            made.normals.push(out.to_array());
            made.uvs.push([share, v]);
        }
    }
    made.triangles = (0..SIDES).map(|i| 2 * i).flat_map(|i| [[i, i + 2, i + 3], [i, i + 3, i + 1]]).collect();
    Some(made)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every triangle faces where its normals point.
    #[test]
    fn solids_face_outwards() {
        let tube = cylinder([DVec3::ZERO, DVec3::new(0.0, 2.0, 1.0)], 0.5).expect("a cylinder");
        for mesh in [rectangle(), cube(), tube] {
            for [a, b, c] in mesh.triangles {
                let [p, q, r] = [a, b, c].map(|i| DVec3::from_array(mesh.positions[i as usize]));
                let normal = DVec3::from_array(mesh.normals[a as usize]);
                assert!((q - p).cross(r - p).dot(normal) > 0.0, "{p} {q} {r}");
            }
        }
    }
}
