//! Stated intervals cover the truth: measurements of synthetic pictures and readings, by 200 seeds. (Those of geometry are beside its
//! other tests.)

mod depth;
mod patches;
mod response;
mod texture;
mod transfer;

use crate::draws::normals;
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use etendue_metrology::Image;

/// A number from 0 to 1 of a seed.
fn unit(seed: u64) -> f64 {
    NoiseStream::new(seed, 1, 0, 0, Pixel { x: 0, y: 0 }, NoiseDraw::Shot).unit_f64()
}

/// A picture of a width, each reading from its number.
fn picture(width: usize, height: usize, mut reading: impl FnMut(usize) -> f64) -> Image {
    let samples = (0..width * height).map(|i| reading(i) as f32).collect();
    Image::from_samples(width, height, samples).expect("a rectangle")
}
