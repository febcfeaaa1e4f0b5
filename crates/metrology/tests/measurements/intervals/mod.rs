//! Stated intervals cover the true value: measurements of synthetic images and readings, with 200 seeds. (Those of geometry are
//! with its other tests.)

mod depth;
mod patches;
mod response;
mod texture;
mod transfer;

use crate::draws::normals;
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use etendue_metrology::Image;

/// A random number from 0 to 1 from a seed.
fn unit(seed: u64) -> f64 {
    NoiseStream::new(seed, 1, 0, 0, Pixel { x: 0, y: 0 }, NoiseDraw::Shot).unit_f64()
}

/// An image of this size, with each reading computed from its index.
fn test_image(width: usize, height: usize, mut reading: impl FnMut(usize) -> f64) -> Image {
    let samples = (0..width * height).map(|i| reading(i) as f32).collect();
    Image::from_samples(width, height, samples).expect("a rectangle")
}
