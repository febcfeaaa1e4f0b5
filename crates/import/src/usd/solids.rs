//! Shapes that UsdGeom knows, as meshes; v points upwards in pictures.

use crate::scenery::Triangles;
use etendue_core::maths::f64 as maths;
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Sides of what is round.
pub(super) const SIDES: u32 = 128;
/// Rings of a half sphere.
const RINGS: u32 = 32;

/// From a shape about z to one about another axis, as UsdGeom turns it: x, y, z go round.
pub(super) fn about(axis: &str) -> DMat3 {
    match axis {
        "X" => DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
        "Y" => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
        _ => DMat3::IDENTITY,
    }
}

/// The same of a plane, whose width is along x (of one about x: along z).
pub(super) fn plane_about(axis: &str) -> DMat3 {
    match axis {
        "X" => DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X),
        "Y" => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        _ => DMat3::IDENTITY,
    }
}

/// A cube about the origin.
pub(super) fn cube(size: f64) -> Triangles {
    let mut made = Triangles::default();
    for axis in ["X", "Y", "Z"] {
        for side in [1.0, -1.0] {
            let turn = about(axis);
            let first = made.positions.len() as u32;
            for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                let place = DVec3::new(side * (2.0 * u - 1.0), 2.0 * v - 1.0, side);
                made.positions.push((0.5 * size * (turn * place)).to_array());
                made.normals.push((side * (turn * DVec3::Z)).to_array());
                made.uvs.push([u, v]);
            }
            made.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    made
}

/// A rectangle in the plane of which z is the normal.
pub(super) fn plane([width, length]: [f64; 2]) -> Triangles {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Triangles {
        positions: corners.map(|[u, v]| [width * (u - 0.5), length * (v - 0.5), 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uvs: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// A surface of revolution about z: rings of radius, height, and the normal's parts outwards and upwards, from below to above.
fn turned(rings: &[[f64; 4]]) -> Triangles {
    let mut made = Triangles::default();
    let rows = rings.len() as u32;
    for i in 0..=SIDES {
        let share = f64::from(i) / f64::from(SIDES);
        let (sin, cos) = maths::sin_cos(share * TAU);
        for (row, [radius, height, out, up]) in rings.iter().enumerate() {
            made.positions.push([radius * cos, radius * sin, *height]);
            made.normals.push([out * cos, out * sin, *up]);
            made.uvs.push([share, row as f64 / (rings.len() - 1) as f64]);
        }
    }
    for side in 0..SIDES {
        for row in (0..rows - 1).filter(|row| rings[*row as usize][..2] != rings[*row as usize + 1][..2]) {
            let (here, next) = (side * rows + row, (side + 1) * rows + row);
            let at_pole = |row: u32| rings[row as usize][0] == 0.0;
            made.triangles.extend((!at_pole(row)).then_some([here, next, next + 1]));
            made.triangles.extend((!at_pole(row + 1)).then_some([here, next + 1, here + 1]));
        }
    }
    made
}

/// A cylinder with its caps; radii at its lower and its upper end.
pub(super) fn cylinder([lower, upper]: [f64; 2], height: f64, has_caps: bool) -> Triangles {
    let half = 0.5 * height;
    let slope = DVec3::new(height, lower - upper, 0.0).normalize_or(DVec3::X);
    let wall = [[lower, -half, slope.x, slope.y], [upper, half, slope.x, slope.y]];
    if !has_caps {
        return turned(&wall);
    }
    let floor = [[0.0, -half, 0.0, -1.0], [lower, -half, 0.0, -1.0]];
    let ceiling = [[upper, half, 0.0, 1.0], [0.0, half, 0.0, 1.0]];
    turned(&[floor, wall, ceiling].concat())
}

/// A cylinder of this height between two half spheres.
pub(super) fn capsule([lower, upper]: [f64; 2], height: f64) -> Triangles {
    let ring = |radius: f64, at: f64, i: u32| {
        let (sin, cos) = maths::sin_cos(FRAC_PI_2 * f64::from(i) / f64::from(RINGS));
        [radius * cos, at + radius * sin, cos, sin]
    };
    let below = (0..=RINGS).rev().map(|i| {
        let [radius, z, out, up] = ring(lower, 0.5 * height, i);
        [radius, -z, out, -up]
    });
    let above = (0..=RINGS).map(|i| ring(upper, 0.5 * height, i));
    turned(&below.chain(above).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume within, and whether triangles face where their normals point.
    fn volume(mesh: &Triangles) -> f64 {
        let mut sum = 0.0;
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|i| DVec3::from_array(mesh.positions[i as usize]));
            let normal: DVec3 = corners.iter().map(|i| DVec3::from_array(mesh.normals[*i as usize])).sum();
            assert!((b - a).cross(c - a).dot(normal) >= 0.0, "{a} {b} {c}");
            sum += a.dot(b.cross(c)) / 6.0;
        }
        sum
    }

    #[test]
    fn solids_hold_what_they_should() {
        use std::f64::consts::PI;
        assert!((volume(&cube(3.0)) - 27.0).abs() < 1e-9);
        // A polygon of 128 sides has 0.9996 of the circle's area.
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
        near(volume(&cylinder([2.0, 2.0], 3.0, true)), 12.0 * PI);
        near(volume(&cylinder([2.0, 0.0], 3.0, true)), 4.0 * PI);
        near(volume(&capsule([1.0, 1.0], 3.0)), 3.0 * PI + 4.0 / 3.0 * PI);
        assert!((about("X") * DVec3::Z - DVec3::X).length() < 1e-12);
        assert!((about("Y") * DVec3::Z - DVec3::Y).length() < 1e-12);
    }
}
