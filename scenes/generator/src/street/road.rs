//! Carriageway, markings, kerbs and pavements.

use crate::mesh::{Mesh, circle};
use crate::paint::{grass, ground};
use crate::random::RandomStream;
use glam::{DVec2, DVec3};
use rand::RngExt;

/// Half the width of the carriageway: one lane, m.
pub(super) const LANE_M: f64 = 3.25;
/// Right edge of the parking lane, m left of the middle.
pub(super) const PARKING_Y: f64 = -5.35;
/// Height of kerbs and pavements, m.
pub(super) const KERB_M: f64 = 0.12;
/// Width of a kerb stone, m.
pub(super) const STONE_M: f64 = 0.15;
/// Fronts of the houses on the right and on the left.
pub(super) const FRONT_Y: [f64; 2] = [-8.0, 7.4];
/// Where the street starts and where it meets the street across its end, m.
pub(super) const REACH_X: [f64; 2] = [-58.0, 162.0];
/// The kerb's nose into the parking lane at the crossing.
pub(super) const NOSE_X: [f64; 2] = [12.0, 24.0];

/// A level rectangle, textured with `size` m a repeat from the world's origin.
fn level(mesh: &mut Mesh, slot: &'static str, x: [f64; 2], y: [f64; 2], z: f64, size: [f64; 2]) {
    let corner = |x: f64, y: f64| (DVec3::new(x, y, z), DVec2::new(x / size[0], y / size[1]));
    mesh.textured(slot, &[corner(x[0], y[0]), corner(x[1], y[0]), corner(x[1], y[1]), corner(x[0], y[1])]);
}

/// A level rectangle without texture.
fn plain(mesh: &mut Mesh, slot: &'static str, x: [f64; 2], y: [f64; 2], z: f64) {
    level(mesh, slot, x, y, z, [1e9, 1e9]);
}

/// The asphalt of both lanes and of the street across the end.
pub(super) fn carriageway() -> Mesh {
    let mut mesh = Mesh::default();
    let [start, end] = REACH_X;
    level(&mut mesh, "asphalt", [start, end], [-LANE_M, LANE_M], 0.0, ground::LANE_M);
    level(&mut mesh, "asphalt", [end, end + 10.0], [-60.0, 60.0], 0.0, ground::LANE_M);
    mesh
}

/// The parking lane with the gutter's stones.
pub(super) fn parking() -> Mesh {
    let mut mesh = Mesh::default();
    let [start, end] = REACH_X;
    level(&mut mesh, "asphalt", [start, end], [PARKING_Y, -LANE_M], 0.0, [ground::LANE_M[0], -5.1]);
    plain(&mut mesh, "kerb", [start, end], [PARKING_Y, PARKING_Y + 0.25], 0.002);
    plain(&mut mesh, "kerb", [start, end], [LANE_M - 0.25, LANE_M], 0.002);
    mesh
}

/// Repaired patches, sealed cracks and manhole covers.
pub(super) fn repairs() -> Mesh {
    let mut mesh = Mesh::default();
    let patches = [
        [4.2, 7.9, -1.35, -0.25],
        [9.5, 10.7, 0.9, 2.9],
        [27.0, 38.5, -3.1, -2.2],
        [46.0, 49.0, 0.4, 2.6],
        [70.0, 84.0, -2.4, -0.9],
    ];
    for [x0, x1, y0, y1] in patches {
        level(&mut mesh, "fresh-asphalt", [x0, x1], [y0, y1], 0.002, [ground::FRESH_M; 2]);
    }
    let mut dice = RandomStream::new(900);
    for (x, y) in [(-6.0, -0.15), (6.0, -2.4), (22.0, -1.1), (12.5, 1.7), (40.0, 0.2), (55.0, -2.0)] {
        seal(&mut mesh, DVec2::new(x, y), DVec2::X, 34, &mut dice);
    }
    for x in [5.5, 10.9, 29.0, 43.0, 61.0] {
        seal(&mut mesh, DVec2::new(x, -3.2), DVec2::Y, 18, &mut dice);
    }
    for (x, y) in [(8.6, -1.55), (33.0, 1.5), (58.0, -1.6)] {
        cover(&mut mesh, DVec3::new(x, y, 0.003));
    }
    mesh
}

/// A crack sealed with bitumen: a strip that wanders along `heading` in steps of 0.35 m.
fn seal(mesh: &mut Mesh, start: DVec2, heading: DVec2, steps: usize, dice: &mut RandomStream) {
    let side = heading.perp();
    let (mut at, mut sway) = (start, 0.0);
    let edge = |at: DVec2, dice: &mut RandomStream| {
        let half = side * dice.random_range(0.018..0.032);
        [at - half, at + half].map(|p| p.extend(0.003))
    };
    let mut before = edge(at, dice);
    for _ in 0..steps {
        sway = 0.7 * sway + dice.random_range(-0.09..0.09);
        at += heading * 0.35 + side * sway;
        let next = edge(at, dice);
        mesh.flat("bitumen", &[before[0], next[0], next[1], before[1]]);
        before = next;
    }
}

/// A manhole cover 0.62 m wide in a ring of concrete.
fn cover(mesh: &mut Mesh, centre: DVec3) {
    let ring = |radius: f64, lift: f64| -> Vec<DVec3> {
        circle(24).map(|[c, s]| centre + DVec3::new(radius * c, radius * s, lift)).collect()
    };
    let (outer, inner) = (ring(0.39, 0.0), ring(0.31, 0.0));
    for i in 0..24 {
        mesh.flat("kerb", &[outer[i], outer[i + 1], inner[i + 1], inner[i]]);
        mesh.flat("manhole", &[centre, inner[i], inner[i + 1]]);
    }
}

/// Centre line, edge of the parking lane and its bays, crossing and stop lines.
pub(super) fn markings() -> Mesh {
    let mut mesh = Mesh::default();
    let mut paint = |x: [f64; 2], y: [f64; 2]| plain(&mut mesh, "marking", x, y, 0.004);
    for i in 0..24 {
        let x = REACH_X[0] + 3.0 + 9.0 * f64::from(i);
        if !(13.0..20.0).contains(&(x + 3.0)) && !(13.0..21.0).contains(&x) {
            paint([x, x + 3.0], [-0.06, 0.06]);
        }
    }
    for i in 0..6 {
        let y = -2.75 + f64::from(i);
        paint([16.0, 20.0], [y - 0.25, y + 0.25]);
    }
    paint([14.3, 14.8], [-3.15, -0.1]);
    paint([21.2, 21.7], [0.1, 3.0]);
    for [from, to] in [[REACH_X[0], NOSE_X[0] - 1.0], [NOSE_X[1] + 1.0, 150.0]] {
        paint([from, to], [-LANE_M - 0.06, -LANE_M + 0.06]);
        let bays = ((to - from) / 5.7) as usize;
        for bay in 0..=bays {
            let x = from + 5.7 * bay as f64;
            paint([x, x + 0.12], [PARKING_Y + 0.25, -LANE_M - 0.06]);
        }
    }
    mesh
}

/// Ten metres of kerb stones along x; their face looks towards +y, the road's side is y > 0.
pub(super) fn kerb() -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..10 {
        let (x0, x1) = (f64::from(i) + 0.004, f64::from(i) + 0.996);
        let line = [[0.0, -0.05], [0.0, KERB_M - 0.025], [-0.012, KERB_M - 0.006], [-0.03, KERB_M], [-STONE_M, KERB_M]];
        for pair in line.windows(2) {
            let p = |x: f64, [y, z]: [f64; 2]| DVec3::new(x, y, z);
            mesh.flat("kerb", &[p(x1, pair[0]), p(x0, pair[0]), p(x0, pair[1]), p(x1, pair[1])]);
        }
        let joint = |x: f64| {
            [
                DVec3::new(x, 0.0, -0.05),
                DVec3::new(x, 0.0, KERB_M - 0.025),
                DVec3::new(x, -STONE_M, KERB_M - 0.01),
                DVec3::new(x, -STONE_M, -0.05),
            ]
        };
        let mut end = joint(x0);
        end.reverse();
        mesh.flat("kerb", &joint(x1));
        mesh.flat("kerb", &end);
    }
    mesh
}

/// The pavements on both sides, the nose at the crossing and the pavement across the end.
pub(super) fn pavement() -> Mesh {
    let mut mesh = Mesh::default();
    let slabs = [ground::SLABS_M; 2];
    let [start, end] = REACH_X;
    let z = KERB_M - 0.002;
    level(&mut mesh, "slabs", [start, end], [FRONT_Y[0] - 0.3, PARKING_Y - STONE_M], z, slabs);
    level(&mut mesh, "slabs", [start, end], [4.9, FRONT_Y[1] + 0.3], z, slabs);
    level(&mut mesh, "slabs", [16.0, 20.0], [LANE_M + STONE_M, 4.9], z, slabs);
    level(&mut mesh, "slabs", [end + 10.2, end + 17.0], [-60.0, 60.0], z, slabs);
    level(
        &mut mesh,
        "slabs",
        [NOSE_X[0] + 0.15, NOSE_X[1] - 0.15],
        [PARKING_Y - STONE_M, -LANE_M - 0.1 - STONE_M],
        z,
        slabs,
    );
    for x in NOSE_X {
        let x0 = if x < 18.0 { x } else { x - STONE_M };
        mesh.block("kerb", DVec3::new(x0, PARKING_Y - 0.05, -0.05), DVec3::new(x0 + STONE_M, -LANE_M - 0.1, KERB_M));
    }
    plain(&mut mesh, "kerb", [start, 16.0], [4.84, 4.9], z + 0.002);
    plain(&mut mesh, "kerb", [20.0, end], [4.84, 4.9], z + 0.002);
    mesh
}

/// The grass between the left kerb and pavement, and the little park between the houses.
pub(super) fn lawn() -> Mesh {
    let mut mesh = Mesh::default();
    let size = [grass::SIDE_M; 2];
    let strip = [LANE_M + STONE_M, 4.86];
    level(&mut mesh, "grass", [REACH_X[0], 16.0], strip, KERB_M - 0.01, size);
    level(&mut mesh, "grass", [20.0, REACH_X[1]], strip, KERB_M - 0.01, size);
    level(&mut mesh, "grass", [10.0, 60.0], [FRONT_Y[1] + 0.3, 40.0], KERB_M - 0.01, size);
    mesh
}

/// A small island of earth in the parking lane for a tree, 2 m long, its middle at the origin.
pub(super) fn island() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.block("kerb", DVec3::new(-1.1, -1.0, -0.05), DVec3::new(1.1, 0.95, KERB_M));
    plain(&mut mesh, "earth", [-0.95, 0.95], [-0.9, 0.8], KERB_M + 0.005);
    mesh
}

/// The ground under everything.
pub(super) fn earth() -> Mesh {
    let mut mesh = Mesh::default();
    plain(&mut mesh, "earth", [-600.0, 800.0], [-600.0, 600.0], -0.06);
    mesh
}
