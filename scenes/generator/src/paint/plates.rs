//! European number plates, 520 mm × 112 mm.

use super::Canvas;
use super::letters::{inked, width};
use glam::{DVec2, DVec3};

/// Width and height, m.
pub const SIZE_M: [f64; 2] = [0.52, 0.112];

/// A white plate with a black border, the blue band on its left and black letters.
#[must_use]
pub fn plate(text: &str) -> Canvas {
    let aspect = SIZE_M[0] / SIZE_M[1];
    let height = (0.62_f64).min((aspect - 0.60) / width(text));
    Canvas::smooth(208, 45, |uv| {
        let p = uv * DVec2::new(SIZE_M[0], SIZE_M[1]) / SIZE_M[1];
        let at =
            DVec2::new((p.x - 0.42 - (aspect - 0.42 - width(text) * height) / 2.0) / height, (p.y - 0.19) / height);
        let edge = p.x.min(aspect - p.x).min(p.y).min(1.0 - p.y);
        match () {
            () if edge < 0.03 => DVec3::splat(0.02),
            () if p.x < 0.40 => DVec3::new(0.01, 0.05, 0.32),
            () if inked(text, at, 0.14) => DVec3::splat(0.02),
            () => DVec3::splat(0.97),
        }
    })
}
