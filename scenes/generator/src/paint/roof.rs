//! Clay roof tiles, about 0.25 m × 0.33 m as they show.

use super::Canvas;
use crate::random::hash;
use etendue_core::maths::f64 as maths;
use glam::DVec3;

/// Side of the texture, m: four tiles by three courses.
pub const SIDE_M: f64 = 1.0;

/// The tiles, v up the slope. Mean reflectance about 0.2 (red clay tile: 0.2 to 0.33).
#[must_use]
pub fn tiles() -> Canvas {
    let side = 96_u32;
    Canvas::point(side, side, |uv| {
        let (along, up) = (uv.x * 4.0, uv.y * 3.0);
        let tone = hash([along.floor() as u32, up.floor() as u32, 1], 31);
        let wave = maths::sin(along.fract() * core::f64::consts::PI);
        let lap = if up.fract() < 0.12 { 0.35 } else { 0.75 + 0.25 * up.fract() };
        DVec3::new(0.33, 0.125, 0.075) * (0.8 + 0.4 * tone) * (0.55 + 0.45 * wave) * lap
    })
}
