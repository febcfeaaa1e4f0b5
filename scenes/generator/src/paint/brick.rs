//! Brickwork in running bond: bricks 240 mm × 71 mm with joints of 10 mm and 12 mm (DIN 105, normal format).

use super::Canvas;
use crate::random::{hash, noise, step};
use glam::DVec3;

/// Side of the texture, m: four bricks by twelve courses.
pub const SIDE_M: f64 = 1.0;

/// The wall. Mean reflectance of a brick about 0.2 (red), of mortar about 0.35.
#[must_use]
pub fn brick() -> Canvas {
    let side = 192_u32;
    Canvas::point(side, side, |uv| {
        let row = (uv.y * 12.0).floor();
        let along = uv.x * 4.0 + 0.5 * (row % 2.0);
        let tone = hash([along.floor() as u32 % 4, row as u32, 1], 21);
        let (s, t) = (along.fract(), (uv.y * 12.0).fract());
        let edge = (s.min(1.0 - s) / 4.0).min(t.min(1.0 - t) / 12.0);
        let grain = 0.9 + 0.2 * noise(uv.x * 48.0, uv.y * 48.0, [48, 48], 22);
        let clay = DVec3::new(0.34, 0.13, 0.085) * (0.7 + 0.6 * tone) * grain;
        let mortar = DVec3::new(0.36, 0.34, 0.30) * grain;
        let inside = step(0.004, 0.008, edge);
        coarse(mortar + (clay - mortar) * inside)
    })
}

/// Steps of colour keep the file small.
fn coarse(colour: DVec3) -> DVec3 {
    (colour * 128.0).round() / 128.0
}
