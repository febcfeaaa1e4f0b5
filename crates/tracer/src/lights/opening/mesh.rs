//! Openings as meshes: parallelograms of two triangles first, then polygons as fans about their middles. Faces point outward, flat ones along their
//! axis.

use core::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{sin, sin_cos};
use glam::{DVec3, Vec3};

use crate::geometry::Mesh;

/// Sides of the polygons that approximate circles.
pub(super) const SIDES: u32 = 48;

const STEP: f64 = TAU / SIDES as f64;

/// Distance of a disc's corners from its middle, in radii: the polygon has the circle's area.
pub(super) fn disc_reach() -> f64 {
    (STEP / sin(STEP)).sqrt()
}

/// Distance of a tube's corners from its axis, in radii: the polygon has the circle's circumference, and so its mean width.
pub(super) fn tube_reach() -> f64 {
    0.5 * STEP / sin(0.5 * STEP)
}

/// Area of a polygon whose corners have this distance from its middle.
pub(super) fn polygon_area(reach: f64) -> f64 {
    PI * reach * reach * sin(STEP) / STEP
}

/// The corner of a polygon of radius 1.
pub(super) fn corner(side: u32, reach: f64) -> [f64; 2] {
    let (sin, cos) = sin_cos(f64::from(side % SIDES) * STEP);
    [reach * cos, reach * sin]
}

/// A box of half sides, or a rectangle if one is zero.
pub(super) fn cuboid(half: DVec3) -> Mesh {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut corners = Vec::new();
    let flat = (0..3).find(|axis| half[*axis] == 0.0);
    for axis in flat.map_or(0..3, |axis| axis..axis + 1) {
        let (normal, s, t) = (axes[axis], axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
        corners.extend([normal - s - t, normal + s - t, normal + s + t, normal - s + t].map(|c| c * half));
        if flat.is_none() {
            corners.extend([-normal - s - t, -normal - s + t, -normal + s + t, -normal + s - t].map(|c| c * half));
        }
    }
    let faces = corners.len() as u32 / 4;
    let triangles = (0..faces).flat_map(|f| [[4 * f, 4 * f + 1, 4 * f + 2], [4 * f, 4 * f + 2, 4 * f + 3]]);
    meshed(&corners, triangles.collect())
}

/// A cylinder of half extents along an axis, or a disc if it has none along it.
pub(super) fn cylinder(half: DVec3, along: usize) -> Mesh {
    let (p, q) = ((along + 1) % 3, (along + 2) % 3);
    let flat = half[along] == 0.0;
    let reach = if flat { disc_reach() } else { tube_reach() };
    let at = |[s, t]: [f64; 2], height: f64| {
        let mut place = DVec3::ZERO;
        (place[p], place[q], place[along]) = (half[p] * s, half[q] * t, height);
        place
    };
    let ring = |height: f64| (0..SIDES).map(move |k| at(corner(k, reach), height)).chain([at([0.0; 2], height)]);
    let next = |k: u32| (k + 1) % SIDES;
    if flat {
        let corners: Vec<DVec3> = ring(0.0).collect();
        return meshed(&corners, (0..SIDES).map(|k| [SIDES, k, next(k)]).collect());
    }
    let corners: Vec<DVec3> = ring(-half[along]).chain(ring(half[along])).collect();
    let (low, high) = (|k: u32| k, |k: u32| SIDES + 1 + k);
    let sides = (0..SIDES).flat_map(|k| {
        let [a, b, c, d] = [low(k), low(next(k)), high(next(k)), high(k)];
        [[a, b, c], [a, c, d]]
    });
    let floor = (0..SIDES).map(|k| [low(SIDES), low(next(k)), low(k)]);
    let roof = (0..SIDES).map(|k| [high(SIDES), high(k), high(next(k))]);
    meshed(&corners, sides.chain(floor).chain(roof).collect())
}

fn meshed(corners: &[DVec3], triangles: Vec<[u32; 3]>) -> Mesh {
    let positions: Vec<Vec3> = corners.iter().map(|corner| corner.as_vec3()).collect();
    Mesh::new(positions, vec![], vec![], triangles, vec![]).expect("extents were checked").0
}
