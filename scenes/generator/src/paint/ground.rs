//! Asphalt and paving slabs, grey.
//!
//! Reflectances: aged asphalt about 0.10 to 0.12, fresh asphalt about 0.05 (Akbari, Pomerantz and Taha 2001, "Cool
//! surfaces and shade trees"); concrete slabs 0.30 to 0.35 (the same source: 0.3 to 0.4 for new concrete).

use super::Canvas;
use crate::random::{hash, noise, step};
use etendue_core::maths::f64 as maths;
use glam::{DVec2, DVec3};

/// Length and width of the road texture, m: the width of one lane.
pub const LANE_M: [f64; 2] = [6.5, 3.25];

/// Side of the slab texture, m.
pub const SLABS_M: f64 = 1.2;

/// Side of the texture of fresh asphalt, m.
pub const FRESH_M: f64 = 1.6;

/// One lane, u along the road: aggregate, mottling, darker wheel tracks and a trace of oil between them.
#[must_use]
pub fn lane() -> Canvas {
    let [length, width] = [768_u32, 384];
    Canvas::point(length, width, |uv| {
        let cell = uv * DVec2::new(f64::from(length), f64::from(width));
        let grain = aggregate(cell, [length, width], 1);
        let mottling = 0.85 + 0.3 * noise(uv.x * 10.0, uv.y * 5.0, [10, 5], 2);
        let fine = 0.92 + 0.16 * noise(uv.x * 52.0, uv.y * 26.0, [52, 26], 3);
        DVec3::splat(0.105 * grain * mottling * fine * wear(uv.y))
    })
}

/// Heights of a road as a picture of plain numbers: hollows some metres wide in 24 m, and lesser ones in them. 0 is the lowest place.
#[must_use]
pub fn hollows() -> Canvas {
    let side = 96_u32;
    Canvas::point(side, side, |uv| {
        let octave = |cells: u32, key: u32| noise(uv.x * f64::from(cells), uv.y * f64::from(cells), [cells; 2], key);
        let height = 0.6 * octave(7, 31) + 0.28 * octave(16, 32) + 0.12 * octave(40, 33);
        DVec3::splat(super::decode(height))
    })
}

/// Fresh dark asphalt of repaired patches.
#[must_use]
pub fn fresh() -> Canvas {
    let side = 128_u32;
    Canvas::point(side, side, |uv| {
        let grain = aggregate(uv * f64::from(side), [side, side], 4);
        let mottling = 0.9 + 0.2 * noise(uv.x * 6.0, uv.y * 6.0, [6, 6], 5);
        DVec3::splat(0.058 * grain * mottling)
    })
}

/// Stones in their binder: single light and dark grains over noise of three texels' size.
fn aggregate(cell: DVec2, size: [u32; 2], key: u32) -> f64 {
    let grain = hash([cell.x as u32, cell.y as u32, 0], key);
    let coarse = noise(cell.x / 2.0, cell.y / 2.0, size.map(|n| n / 2), key + 100);
    let stone = if grain > 0.965 { 0.45 } else { 0.0 };
    let pit = if grain < 0.03 { -0.35 } else { 0.0 };
    0.8 + 0.2 * grain + 0.22 * coarse + stone + pit
}

/// Wheel tracks 1.5 m apart and an oil trace in the middle of a lane, `v` across it.
fn wear(v: f64) -> f64 {
    let hump = |centre: f64, width: f64| maths::exp(-((v - centre) / width) * ((v - centre) / width));
    1.0 - 0.13 * (hump(0.27, 0.09) + hump(0.73, 0.09)) - 0.07 * hump(0.5, 0.06)
        + 0.05 * (hump(0.0, 0.06) + hump(1.0, 0.06))
}

/// Concrete slabs 0.30 m × 0.30 m in courses shifted by half a slab.
#[must_use]
pub fn slabs() -> Canvas {
    let side = 256_u32;
    Canvas::point(side, side, |uv| {
        let row = (uv.y * 4.0).floor();
        let along = uv.x * 4.0 + 0.5 * (row % 2.0);
        let slab = hash([along.floor() as u32 % 4, row as u32, 1], 11);
        let (s, t) = (along.fract(), (uv.y * 4.0).fract());
        let edge = s.min(1.0 - s).min(t).min(1.0 - t) * 0.30;
        let joint = step(0.002, 0.006, edge);
        let grain = hash([(uv.x * 256.0) as u32, (uv.y * 256.0) as u32, 2], 12);
        let stain = 0.92 + 0.16 * noise(uv.x * 7.0, uv.y * 7.0, [7, 7], 13);
        DVec3::splat((0.33 * (0.88 + 0.24 * slab) * stain * (0.95 + 0.1 * grain)) * (0.4 + 0.6 * joint))
    })
}
