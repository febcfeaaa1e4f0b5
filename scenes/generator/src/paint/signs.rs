//! Traffic signs after the German catalogue (StVO, annexes 1 to 3), painted in plain colours.
//!
//! Colours: daylight colours of retroreflective sheeting as ranges of luminance factor in EN 12899-1 (white ≥ 0.35,
//! yellow ≥ 0.27, red ≥ 0.05, blue ≥ 0.01); the values within those ranges are stand-ins.

use super::letters::{inked, width};
use super::{Canvas, segment_distance};
use glam::{DVec2, DVec3};

const WHITE: DVec3 = DVec3::new(0.97, 0.97, 0.95);
const BLACK: DVec3 = DVec3::new(0.02, 0.02, 0.02);
const RED: DVec3 = DVec3::new(0.55, 0.025, 0.03);
const BLUE: DVec3 = DVec3::new(0.02, 0.10, 0.42);
const YELLOW: DVec3 = DVec3::new(0.92, 0.62, 0.03);

/// Pixels along a side of a sign.
const SIDE: u32 = 160;

/// A painting over the square −1 … 1, y up.
fn sign(colour: impl Fn(DVec2) -> DVec3) -> Canvas {
    Canvas::smooth(SIDE, SIDE, |uv| colour(uv * 2.0 - 1.0))
}

/// Sign 274: top speed 30 km/h.
#[must_use]
pub fn limit_30() -> Canvas {
    sign(|p| {
        let height = 0.78;
        let at = (p + DVec2::new(width("30") / 2.0, 0.5) * height) / height;
        match p.length() {
            r if r > 0.98 => WHITE,
            r if r > 0.74 => RED,
            _ if inked("30", at, 0.17) => BLACK,
            _ => WHITE,
        }
    })
}

/// Sign 306: priority road. The board stands on its corner, so the painting is a plain square.
#[must_use]
pub fn priority() -> Canvas {
    sign(|p| match p.abs().max_element() {
        r if r > 0.96 => BLACK,
        r if r > 0.60 => WHITE,
        r if r > 0.56 => BLACK,
        _ => YELLOW,
    })
}

/// Sign 286: restricted stopping.
#[must_use]
pub fn no_parking() -> Canvas {
    sign(|p| {
        let bar = (p.x + p.y).abs() < 0.15;
        if p.length() > 0.78 || bar { RED } else { BLUE }
    })
}

/// Sign 101: danger, a triangle.
#[must_use]
pub fn danger() -> Canvas {
    sign(|p| {
        let inside = triangle(p, DVec2::new(0.0, -0.1), 0.52);
        let stroke = segment_distance(p, DVec2::new(0.0, 0.32), DVec2::new(0.0, -0.22)) < 0.075;
        let dot = (p - DVec2::new(0.0, -0.43)).length() < 0.085;
        match (inside, stroke || dot) {
            (false, _) => RED,
            (true, true) => BLACK,
            (true, false) => WHITE,
        }
    })
}

/// Sign 350: pedestrian crossing, a walker on stripes in a white triangle on blue.
#[must_use]
pub fn crossing() -> Canvas {
    sign(|p| {
        if !triangle(p, DVec2::new(0.0, -0.22), 0.86) {
            return BLUE;
        }
        let stripe = p.y < -0.46 && p.y > -0.6 && (p.x * 4.0 + 8.0).fract() < 0.5 && p.x.abs() < 0.62;
        if walker(p) || stripe { BLACK } else { WHITE }
    })
}

/// Whether `p` is inside an upright triangle of this size about `centre`.
fn triangle(p: DVec2, centre: DVec2, size: f64) -> bool {
    let q = (p - centre) / size;
    q.y > -0.5 && q.y < 1.0 - 1.732 * q.x.abs()
}

/// A walking person of single strokes.
fn walker(p: DVec2) -> bool {
    let bones = [
        [0.0, 0.16, 0.0, -0.12, 0.075],
        [0.0, -0.1, -0.16, -0.42, 0.05],
        [0.0, -0.1, 0.17, -0.42, 0.05],
        [0.0, 0.12, -0.17, -0.08, 0.04],
        [0.0, 0.12, 0.18, -0.06, 0.04],
    ];
    let head = (p - DVec2::new(0.01, 0.3)).length() < 0.085;
    let on = |[ax, ay, bx, by, w]: [f64; 5]| segment_distance(p, DVec2::new(ax, ay), DVec2::new(bx, by)) < w;
    head || bones.into_iter().any(on)
}

/// A board with a line of text.
#[must_use]
pub fn board(text: &str, pixels: [u32; 2], ground: DVec3, ink: DVec3) -> Canvas {
    let aspect = f64::from(pixels[0]) / f64::from(pixels[1]);
    let height = (0.6_f64).min(0.9 * aspect / width(text));
    Canvas::smooth(pixels[0], pixels[1], |uv| {
        let p = DVec2::new((uv.x - 0.5) * aspect, uv.y - 0.5);
        let at = (p + DVec2::new(width(text) / 2.0, 0.5) * height) / height;
        if inked(text, at, 0.15) { ink } else { ground }
    })
}
