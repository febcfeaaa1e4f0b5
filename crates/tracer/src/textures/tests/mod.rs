//! Textures as surfaces use them.

mod alpha;
mod grazing;
mod tiled;

use super::*;

fn picture(width: u32, height: u32, sampling: Sampling, texel: impl Fn(u32, u32) -> f32) -> ImageTexture {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let texels = places.map(|(x, y)| [texel(x, y); 3]).collect();
    ImageTexture::new(width, height, Texels::Float(texels), sampling).expect("a picture")
}
