//! Roofs: pitched with dormers, gutter and chimney, or flat behind a parapet.

use super::house::{House, Roof};
use crate::mesh::Mesh;
use crate::paint::roof::SIDE_M;
use glam::{DVec2, DVec3};

/// How far a pitched roof hangs over the front, m.
const OVERHANG_M: f64 = 0.35;
/// Rise of a pitched roof over its run: about 42°.
const PITCH: f64 = 0.9;

/// The roof of a house.
pub(super) fn add(house: &House, mesh: &mut Mesh) {
    match house.roof {
        Roof::Pitched(dormers) => pitched(house, dormers, mesh),
        Roof::Flat => flat(house, mesh),
    }
}

fn pitched(house: &House, dormers: usize, mesh: &mut Mesh) {
    let (eaves, half) = (house.eaves(), house.depth / 2.0);
    let run = half + OVERHANG_M;
    let ridge = eaves + half * PITCH;
    let low = eaves - OVERHANG_M * PITCH;
    let slope = (run * run + (ridge - low) * (ridge - low)).sqrt();
    let at = |x: f64, y: f64, z: f64, v: f64| (DVec3::new(x, y, z), DVec2::new(x, v) / SIDE_M);
    let w = house.width;
    let back = house.depth + OVERHANG_M;
    mesh.textured(
        "tiles",
        &[
            at(0.0, -OVERHANG_M, low, 0.0),
            at(w, -OVERHANG_M, low, 0.0),
            at(w, half, ridge, slope),
            at(0.0, half, ridge, slope),
        ],
    );
    mesh.textured(
        "tiles",
        &[at(w, back, low, 0.0), at(0.0, back, low, 0.0), at(0.0, half, ridge, slope), at(w, half, ridge, slope)],
    );
    let p = DVec3::new;
    mesh.flat("stone", &[p(0.0, 0.0, low), p(w, 0.0, low), p(w, -OVERHANG_M, low), p(0.0, -OVERHANG_M, low)]);
    for x in [0.0, w] {
        let mut gable = [
            (p(x, 0.0, eaves), DVec2::ZERO),
            (p(x, half, ridge), DVec2::new(half, half)),
            (p(x, house.depth, eaves), DVec2::new(house.depth, 0.0)),
        ];
        if x > 0.0 {
            gable.reverse();
        }
        mesh.textured("wall", &gable);
    }
    gutter(house, low, mesh);
    for i in 0..dormers {
        dormer(w * (i as f64 + 0.5) / dormers as f64, eaves, mesh);
    }
    let stack = p(w * 0.72, half - 1.2, ridge - 1.3);
    mesh.block("brick-plain", stack, stack + p(0.75, 0.5, 2.2));
}

/// A zinc gutter along the eaves and a pipe down the front's left end.
fn gutter(house: &House, low: f64, mesh: &mut Mesh) {
    let y = -OVERHANG_M - 0.06;
    mesh.tube("zinc", &[(DVec3::new(0.0, y, low), 0.07), (DVec3::new(house.width, y, low), 0.07)], 8);
    let x = 0.12;
    let bend = [
        (DVec3::new(x, y, low - 0.05), 0.045),
        (DVec3::new(x, -0.24, low - 0.45), 0.045),
        (DVec3::new(x, -0.24, low - 0.6), 0.045),
        (DVec3::new(x, -0.24, 0.05), 0.045),
    ];
    mesh.tube("zinc", &bend, 8);
}

/// A dormer: a box with a window and a small flat zinc roof.
fn dormer(centre: f64, eaves: f64, mesh: &mut Mesh) {
    let (half, front, low, high) = (0.8, 0.7, eaves + 0.45, eaves + 2.1);
    let back = front + (high - low) / PITCH + 0.4;
    let (a, b) = (DVec3::new(centre - half, front, low), DVec3::new(centre + half, back, high));
    for (axis, upper) in [(1, false), (0, false), (0, true)] {
        mesh.block_side("zinc", a, b, axis, upper);
    }
    mesh.block("zinc", DVec3::new(a.x - 0.12, front - 0.15, high), DVec3::new(b.x + 0.12, back, high + 0.12));
    let pane = |mesh: &mut Mesh, slot: &'static str, inset: f64, y: f64| {
        let p = |x: f64, z: f64| DVec3::new(x, y, z);
        let (x0, x1, z0, z1) = (a.x + inset, b.x - inset, low + 0.15 + inset, high - inset);
        mesh.flat(slot, &[p(x0, z0), p(x1, z0), p(x1, z1), p(x0, z1)]);
    };
    pane(mesh, "frame", 0.15, front - 0.01);
    pane(mesh, "glass", 0.23, front - 0.02);
}

fn flat(house: &House, mesh: &mut Mesh) {
    let (w, d, z) = (house.width, house.depth, house.eaves());
    let p = DVec3::new;
    mesh.flat("zinc", &[p(0.0, 0.0, z), p(w, 0.0, z), p(w, d, z), p(0.0, d, z)]);
    for (low, high) in [
        (p(0.0, 0.0, z), p(w, 0.25, z + 0.6)),
        (p(0.0, d - 0.25, z), p(w, d, z + 0.6)),
        (p(0.0, 0.0, z), p(0.25, d, z + 0.6)),
        (p(w - 0.25, 0.0, z), p(w, d, z + 0.6)),
    ] {
        mesh.block("wall", low, high);
    }
    mesh.block("stone", p(-0.03, -0.05, z + 0.6), p(w + 0.03, 0.3, z + 0.66));
}
