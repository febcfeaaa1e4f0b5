//! Hills of any number of triangles, for what depends on their number.
//!
//! Two kilometres square; heights are octaves of smooth noise on lattices of hashed values, so that more triangles show
//! the same hills in more detail.

use etendue_core::Ray;
use etendue_tracer::geometry::Mesh;
use glam::Vec3;

/// Length of a side, m.
const SIDE_M: f32 = 2000.0;
/// Where the camera stands: over the southern edge.
const EYE_M: Vec3 = Vec3::new(0.0, -1000.0, 260.0);
/// Pixels of the picture.
const SIZE: (u32, u32) = (960, 600);
/// Half the width of the picture, over its distance.
const HALF_WIDTH: f32 = 0.6;

/// Direction to the sun: 35° high, from the west.
pub const SUN: Vec3 = Vec3::new(-0.779_8, -0.248_6, 0.574_6);

/// Hills of about `triangles` triangles (two a cell of a square grid), with the camera in the origin.
#[must_use]
pub fn mesh(triangles: usize) -> Mesh {
    let (positions, triangles) = grid(triangles);
    Mesh::new(positions, vec![], vec![], triangles, vec![]).expect("hills are legal").0
}

/// The vertices of hills of about `triangles` triangles relative to the camera, and the vertices of each triangle.
#[must_use]
pub fn grid(triangles: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let cells = ((triangles as f64 / 2.0).sqrt().round() as u32).max(1);
    let at = |i: u32| SIDE_M * (i as f32 / cells as f32 - 0.5);
    let points = (0..=cells).flat_map(|y| (0..=cells).map(move |x| (at(x), at(y))));
    let positions = points.map(|(x, y)| Vec3::new(x, y, height_m(x, y)) - EYE_M).collect();
    let corner = |x: u32, y: u32| y * (cells + 1) + x;
    let cell = |x: u32, y: u32| {
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..cells).flat_map(|y| (0..cells).flat_map(move |x| cell(x, y))).collect();
    (positions, triangles)
}

/// A ray through the centre of every pixel of a camera that looks north and a little down, row by row.
#[must_use]
pub fn primary() -> Vec<Ray> {
    let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x as f32 + 0.5, y as f32 + 0.5)));
    pixels.map(|(x, y)| Ray::new(Vec3::ZERO, direction(x, y), 0.0)).collect()
}

fn direction(x: f32, y: f32) -> Vec3 {
    let scale = 2.0 * HALF_WIDTH / SIZE.0 as f32;
    let (right, up) = ((x - SIZE.0 as f32 / 2.0) * scale, (SIZE.1 as f32 / 2.0 - y) * scale);
    Vec3::new(right, 1.0, up - 0.25).normalize()
}

/// Eleven octaves from 500 m to half a metre, each half as high as the one before.
fn height_m(x: f32, y: f32) -> f32 {
    let octave = |i: i32| {
        let scale = 500.0 / (1 << i) as f32;
        noise(x / scale, y / scale, i as u32) * 0.24 * scale
    };
    (0..11).map(octave).sum()
}

/// Smooth noise between 0 and 1.
fn noise(x: f32, y: f32, layer: u32) -> f32 {
    let (x0, y0) = (x.floor(), y.floor());
    let at = |dx: i32, dy: i32| lattice(x0 as i32 + dx, y0 as i32 + dy, layer);
    let (fx, fy) = (smooth(x - x0), smooth(y - y0));
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    low + (high - low) * fy
}

fn smooth(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}

/// A hashed value between 0 and 1.
fn lattice(x: i32, y: i32, layer: u32) -> f32 {
    let mut h =
        (x as u32).wrapping_mul(0x8da6_b343) ^ (y as u32).wrapping_mul(0xd816_3841) ^ layer.wrapping_mul(0xcb1a_b31f);
    h = (h ^ h >> 16).wrapping_mul(0x7feb_352d);
    h = (h ^ h >> 15).wrapping_mul(0x846c_a68b);
    (h >> 8) as f32 / (1 << 24) as f32
}
