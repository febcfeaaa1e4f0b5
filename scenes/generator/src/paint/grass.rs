//! Mown grass seen from above.

use super::Canvas;
use crate::random::{hash, noise};
use glam::DVec3;

/// Side of the texture, m.
pub const SIDE_M: f64 = 1.0;

/// Blades and gaps; a lawn reflects about 0.05 in red and blue and 0.1 in green light.
#[must_use]
pub fn grass() -> Canvas {
    let side = 128_u32;
    Canvas::point(side, side, |uv| {
        let cell = [(uv.x * 128.0) as u32, (uv.y * 64.0) as u32, 1];
        let blade = (hash(cell, 41) * 8.0).floor() / 8.0;
        let patch = noise(uv.x * 6.0, uv.y * 6.0, [6, 6], 42);
        let dry = DVec3::new(0.16, 0.13, 0.06);
        let green = DVec3::new(0.055, 0.105, 0.028);
        (green + (dry - green) * 0.25 * patch * blade) * (0.55 + 0.9 * blade)
    })
}
