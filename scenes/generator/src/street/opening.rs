//! What fills the holes of a front: windows, doors, shop windows, balconies. Fronts look towards −y.

use crate::mesh::Mesh;
use crate::random::RandomStream;
use glam::{DVec2, DVec3};
use rand::RngExt;

/// Depth of the wall before the frame, m.
const REVEAL_M: f64 = 0.14;
/// Depth of the glass behind the front of its frame, m.
const GLASS_M: f64 = 0.045;

/// Kinds of glazed openings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Frame {
    /// Two casements on a sill.
    Window,
    /// A glazed door to a balcony.
    Door,
}

/// The visible sides of a block on a front: front, top and both ends.
pub(super) fn panel(mesh: &mut Mesh, slot: &'static str, low: DVec3, high: DVec3) {
    mesh.block_side(slot, low, high, 1, false);
    mesh.block_side(slot, low, high, 2, true);
    mesh.block_side(slot, low, high, 0, false);
    mesh.block_side(slot, low, high, 0, true);
}

/// The four sides of a hole, from the wall's face to the frame: the inside of a box.
pub(super) fn reveal(mesh: &mut Mesh, slot: &'static str, low: DVec2, high: DVec2) {
    let corner = |x: f64, z: f64| [DVec3::new(x, 0.0, z), DVec3::new(x, REVEAL_M + GLASS_M, z)];
    let round = [
        corner(low.x, low.y),
        corner(high.x, low.y),
        corner(high.x, high.y),
        corner(low.x, high.y),
        corner(low.x, low.y),
    ];
    for pair in round.windows(2) {
        mesh.flat(slot, &[pair[0][0], pair[1][0], pair[1][1], pair[0][1]]);
    }
}

/// A rectangle that looks towards −y.
fn pane(mesh: &mut Mesh, slot: &'static str, x: [f64; 2], z: [f64; 2], y: f64) {
    let p = |x: f64, z: f64| DVec3::new(x, y, z);
    mesh.flat(slot, &[p(x[0], z[0]), p(x[1], z[0]), p(x[1], z[1]), p(x[0], z[1])]);
}

/// Bars of a frame about a pane: rectangles in the frame's face and the inner sides that stand back to the glass.
fn sash(mesh: &mut Mesh, slot: &'static str, low: DVec2, high: DVec2, bar: f64) {
    let (y, inner_low, inner_high) = (REVEAL_M, low + bar, high - bar);
    pane(mesh, slot, [low.x, inner_low.x], [low.y, high.y], y);
    pane(mesh, slot, [inner_high.x, high.x], [low.y, high.y], y);
    pane(mesh, slot, [inner_low.x, inner_high.x], [low.y, inner_low.y], y);
    pane(mesh, slot, [inner_low.x, inner_high.x], [inner_high.y, high.y], y);
    let corner = |x: f64, z: f64| [DVec3::new(x, y, z), DVec3::new(x, y + GLASS_M, z)];
    let (a, b) = (corner(inner_low.x, inner_low.y), corner(inner_high.x, inner_low.y));
    let (c, d) = (corner(inner_high.x, inner_high.y), corner(inner_low.x, inner_high.y));
    for [p, q] in [[a, b], [b, c], [c, d], [d, a]] {
        mesh.flat(slot, &[p[0], q[0], q[1], p[1]]);
    }
}

/// A window of two casements; behind the glass a dark room, a curtain or a shutter partly down.
pub(super) fn window(mesh: &mut Mesh, low: DVec2, high: DVec2, frame: Frame, surround: bool, dice: &mut RandomStream) {
    let middle = (low.x + high.x) / 2.0;
    let glass = if dice.random_bool(0.35) { "curtain-glass" } else { "glass" };
    for x in [[low.x, middle], [middle, high.x]] {
        sash(mesh, "frame", DVec2::new(x[0], low.y), DVec2::new(x[1], high.y), 0.06);
        pane(mesh, glass, x, [low.y, high.y], REVEAL_M + GLASS_M);
    }
    if dice.random_bool(0.22) {
        let down = high.y - (high.y - low.y) * dice.random_range(0.25..0.7);
        pane(mesh, "shutter", [low.x, high.x], [down, high.y], REVEAL_M - 0.02);
    }
    if frame == Frame::Window {
        let sill_low = DVec3::new(low.x - 0.05, -0.07, low.y - 0.05);
        panel(mesh, "stone", sill_low, DVec3::new(high.x + 0.05, 0.0, low.y));
        mesh.block_side("stone", sill_low, DVec3::new(high.x + 0.05, 0.0, low.y), 2, false);
    }
    if surround {
        raised_surround(mesh, low, high);
    }
}

fn raised_surround(mesh: &mut Mesh, low: DVec2, high: DVec2) {
    let (w, out) = (0.14, 0.03);
    let strips = [
        [low.x - w, low.x, low.y, high.y + w],
        [high.x, high.x + w, low.y, high.y + w],
        [low.x, high.x, high.y, high.y + w],
    ];
    for [x0, x1, z0, z1] in strips {
        panel(mesh, "stone", DVec3::new(x0, -out, z0), DVec3::new(x1, 0.0, z1));
    }
}

/// A house door of panels with a light above, on one step.
pub(super) fn door(mesh: &mut Mesh, low: DVec2, high: DVec2) {
    let head = high.y - 0.5;
    sash(mesh, "door", DVec2::new(low.x, head), high, 0.06);
    pane(mesh, "glass", [low.x, high.x], [head, high.y], REVEAL_M + GLASS_M);
    sash(mesh, "door", low, DVec2::new(high.x, head), 0.10);
    pane(mesh, "door", [low.x, high.x], [low.y, head], REVEAL_M + GLASS_M);
    let lock = DVec3::new(high.x - 0.2, REVEAL_M - 0.04, low.y + 1.0);
    panel(mesh, "metal", lock, lock + DVec3::new(0.12, 0.08, 0.03));
    panel(mesh, "stone", DVec3::new(low.x - 0.1, -0.3, 0.0), DVec3::new(high.x + 0.1, 0.2, low.y));
}

/// A shop window in a dark metal frame.
pub(super) fn shop_window(mesh: &mut Mesh, low: DVec2, high: DVec2) {
    sash(mesh, "shop-frame", low, high, 0.05);
    pane(mesh, "glass", [low.x, high.x], [low.y, high.y], REVEAL_M + GLASS_M);
}

/// The board above a shop, its texture once along it.
pub(super) fn fascia(mesh: &mut Mesh, slot: &'static str, from: f64, to: f64) {
    let (low, high, out) = (2.85, 3.5, 0.14);
    panel(mesh, "shop-frame", DVec3::new(from, -out, low), DVec3::new(to, 0.0, high));
    let (centre, half) = ((from + to) / 2.0, 2.3_f64.min((to - from) / 2.0 - 0.1));
    let corner = |s: f64, t: f64| {
        (
            DVec3::new(centre + (2.0 * s - 1.0) * half, -out - 0.01, low + 0.04 + t * (high - low - 0.08)),
            DVec2::new(s, t),
        )
    };
    mesh.textured(slot, &[corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]);
}

/// A balcony of a slab and railings about a bay.
pub(super) fn balcony(mesh: &mut Mesh, centre: f64, floor: f64, out: f64) {
    let half = 1.25;
    let (x0, x1) = (centre - half, centre + half);
    mesh.block("stone", DVec3::new(x0, -out, floor - 0.16), DVec3::new(x1, 0.05, floor));
    let rail = |mesh: &mut Mesh, low: DVec3, high: DVec3| mesh.block("metal", low, high);
    for z in [0.10, 0.95] {
        rail(mesh, DVec3::new(x0, -out, floor + z), DVec3::new(x1, -out + 0.04, floor + z + 0.04));
        for x in [x0, x1 - 0.04] {
            rail(mesh, DVec3::new(x, -out, floor + z), DVec3::new(x + 0.04, 0.0, floor + z + 0.04));
        }
    }
    for i in 0..=16 {
        let x = x0 + (x1 - x0 - 0.02) * f64::from(i) / 16.0;
        let (low, high) = (DVec3::new(x, -out + 0.01, floor + 0.12), DVec3::new(x + 0.02, -out + 0.03, floor + 0.97));
        mesh.block_side("metal", low, high, 1, false);
        mesh.block_side("metal", low, high, 1, true);
        mesh.block_side("metal", low, high, 0, false);
        mesh.block_side("metal", low, high, 0, true);
    }
}
