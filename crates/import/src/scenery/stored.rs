//! Pixels of an image as numbers, without their encoding.

use etendue_scene::asset::{ImageAsset, ImagePixels};

/// Red, green, blue and opacity of each pixel as stored; integers are scaled so that their largest is 1.
pub(crate) fn stored_pixels(image: &ImageAsset) -> Vec<[f32; 4]> {
    let byte = |b: u8| f32::from(b) / 255.0;
    let grey = |g: f32| [g, g, g, 1.0];
    match &image.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|g| grey(byte(*g))).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|g| grey(f32::from(*g) / 65_535.0)).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|p| p.map(byte)).map(|[r, g, b]| [r, g, b, 1.0]).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|p| p.map(byte)).collect(),
        ImagePixels::Rgb32F(p) => p.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect(),
        ImagePixels::Rgba32F(p) => p.clone(),
    }
}
