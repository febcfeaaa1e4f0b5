//! Lamp posts, sign posts, bins, bollards and benches.

use crate::mesh::{Mesh, along, circle};
use crate::random::RandomStream;
use glam::{DAffine3, DVec2, DVec3};
use rand::RngExt;

/// A lamp post 7 m high whose arm reaches 1.4 m towards +y.
#[must_use]
pub(super) fn lamp_post() -> Mesh {
    let mut mesh = Mesh::default();
    let p = DVec3::new;
    let pole = [
        (p(0.0, 0.0, 0.0), 0.085),
        (p(0.0, 0.0, 1.2), 0.085),
        (p(0.0, 0.0, 1.25), 0.062),
        (p(0.0, 0.0, 6.2), 0.045),
        (p(0.0, 0.08, 6.6), 0.042),
        (p(0.0, 0.30, 6.88), 0.040),
        (p(0.0, 0.65, 7.0), 0.038),
        (p(0.0, 0.95, 7.02), 0.036),
    ];
    mesh.tube("galvanised", &pole, 12);
    let head = |mesh: &mut Mesh, slot: &'static str, z: [f64; 2], inset: f64| {
        mesh.block(slot, p(-0.14 + inset, 0.85 + inset, z[0]), p(0.14 - inset, 1.45 - inset, z[1]));
    };
    head(&mut mesh, "galvanised", [6.97, 7.08], 0.0);
    head(&mut mesh, "lamp-glass", [6.945, 6.97], 0.03);
    mesh
}

/// The outline of a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Board {
    /// A disc.
    Round,
    /// A triangle, point up.
    Triangle,
    /// A square.
    Square,
    /// A square standing on its corner.
    Diamond,
}

impl Board {
    /// Corners on the square −1 … 1 of the painting and, in metres, on the board.
    fn corners(self) -> Vec<(DVec2, DVec2)> {
        let shape: Vec<DVec2> = match self {
            Self::Round => circle(32).take(32).map(DVec2::from_array).collect(),
            Self::Triangle => [[-0.995, -0.86], [0.995, -0.86], [0.0, 0.863]].map(DVec2::from_array).to_vec(),
            Self::Square | Self::Diamond => {
                [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(DVec2::from_array).to_vec()
            }
        };
        let turn = |p: DVec2| {
            if self == Self::Diamond { DVec2::new(p.x - p.y, p.x + p.y) * core::f64::consts::FRAC_1_SQRT_2 } else { p }
        };
        shape.into_iter().map(|p| (p, turn(p))).collect()
    }
}

/// A board is its outline, half its size in m, the height of its centre in m and its material slot.
pub(super) type Sign = (Board, f64, f64, &'static str);

/// The post that carries boards up to this height, m.
#[must_use]
pub(super) fn sign_post(height: f64) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.tube("galvanised", &[(DVec3::ZERO, 0.03), (DVec3::Z * height, 0.03)], 10);
    disc(&mut mesh, "galvanised", DVec3::Z * height, 0.03, 10);
    mesh
}

/// The boards of a post, painted side towards −x (towards the traffic that drives along +x).
#[must_use]
pub(super) fn sign_boards(boards: &[Sign]) -> Mesh {
    let mut mesh = Mesh::default();
    for &(outline, half, height, slot) in boards {
        board(&mut mesh, outline, half, height, slot);
    }
    mesh
}

fn board(mesh: &mut Mesh, outline: Board, half: f64, height: f64, slot: &'static str) {
    let corners = outline.corners();
    // Seen from −x looking along +x, right is −y.
    let at = |x: f64, q: DVec2| DVec3::new(x, -q.x * half, height + q.y * half);
    let (front, back) = (-0.045, -0.042);
    fan(mesh, slot, &corners.iter().map(|&(p, q)| (at(front, q), (p + 1.0) / 2.0)).collect::<Vec<_>>());
    let rear: Vec<_> = corners.iter().rev().map(|&(_, q)| (at(back, q), DVec2::ZERO)).collect();
    fan(mesh, "galvanised", &rear);
}

/// A convex outline as quads and triangles about its first corner.
fn fan(mesh: &mut Mesh, slot: &'static str, corners: &[(DVec3, DVec2)]) {
    let mut i = 1;
    while i + 1 < corners.len() {
        let last = (i + 2).min(corners.len() - 1);
        let mut polygon = vec![corners[0]];
        polygon.extend(&corners[i..=last]);
        mesh.textured(slot, &polygon);
        i += 2;
    }
}

fn disc(mesh: &mut Mesh, slot: &'static str, centre: DVec3, radius: f64, segments: usize) {
    let ring: Vec<DVec3> = circle(segments).map(|[c, s]| centre + DVec3::new(c, s, 0.0) * radius).collect();
    for pair in ring.windows(2) {
        mesh.flat(slot, &[centre, pair[0], pair[1]]);
    }
}

/// A round litter bin on a post.
#[must_use]
pub(super) fn bin() -> Mesh {
    let mut mesh = Mesh::default();
    let profile =
        [[0.25, 0.0], [0.25, 0.17], [0.85, 0.19], [0.87, 0.20], [0.90, 0.19], [0.90, 0.13], [0.80, 0.12], [0.80, 0.0]];
    mesh.lathe("bin", DAffine3::IDENTITY, &profile, 16);
    mesh.tube("galvanised", &[(DVec3::ZERO, 0.03), (DVec3::Z * 0.3, 0.03)], 8);
    mesh
}

/// A bollard 0.9 m high with a light band.
#[must_use]
pub(super) fn bollard() -> Mesh {
    let mut mesh = Mesh::default();
    let frame = DAffine3::IDENTITY;
    mesh.lathe("bollard", frame, &[[0.0, 0.055], [0.70, 0.055]], 14);
    mesh.lathe("frame", frame, &[[0.70, 0.056], [0.80, 0.056]], 14);
    mesh.lathe("bollard", frame, &[[0.80, 0.055], [0.88, 0.055], [0.915, 0.04], [0.925, 0.0]], 14);
    mesh
}

/// A bench with slats of wood that looks towards +y.
#[must_use]
pub(super) fn bench() -> Mesh {
    let mut mesh = Mesh::default();
    let p = DVec3::new;
    for i in 0..4 {
        let y = 0.12 * f64::from(i);
        mesh.block("wood", p(-0.9, y, 0.43), p(0.9, y + 0.10, 0.46));
    }
    for i in 0..3 {
        let z = 0.55 + 0.13 * f64::from(i);
        mesh.block("wood", p(-0.9, -0.06 - 0.02 * f64::from(i), z), p(0.9, -0.03 - 0.02 * f64::from(i), z + 0.10));
    }
    for x in [-0.7, 0.66] {
        mesh.block("bollard", p(x, -0.08, 0.0), p(x + 0.04, 0.46, 0.43));
        mesh.block("bollard", p(x, -0.12, 0.43), p(x + 0.04, -0.06, 0.92));
    }
    mesh
}

/// A closed hedge block is a box of leaves: length along x, depth along y and height, m.
#[must_use]
pub(super) fn hedge(size: DVec3, leaves: usize, key: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut dice = RandomStream::new(key);
    mesh.block("hedge", DVec3::new(0.08, 0.08, 0.0), size - DVec3::new(0.08, 0.08, 0.08));
    for _ in 0..leaves {
        let mut at = DVec3::new(dice.random::<f64>(), dice.random::<f64>(), dice.random::<f64>()) * size;
        let axis = dice.random_range(0..3);
        at[axis] = if axis == 2 || dice.random_bool(0.5) { size[axis] - 0.04 } else { 0.04 };
        let normal =
            DVec3::new(dice.random_range(-1.0..1.0), dice.random_range(-1.0..1.0), dice.random_range(-0.2..1.0))
                .normalize_or(DVec3::Z);
        let frame = along(at, normal);
        let (a, b) = (frame.matrix3.x_axis * 0.07, frame.matrix3.y_axis * 0.045);
        mesh.flat(if dice.random_bool(0.5) { "leaf" } else { "leaf-light" }, &[at - a, at - b, at + a, at + b]);
    }
    mesh
}
