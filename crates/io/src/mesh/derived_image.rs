//! Images made from those that a mesh's materials name: one number per texel, tinted colours.

use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_spectra::colour;

use crate::hash;

/// Red, green, blue and opacity of every pixel as numbers 0 … 1 (floats may exceed 1), as in the file.
fn pixels(image: &ImageAsset) -> Box<dyn Iterator<Item = [f32; 4]> + '_> {
    let byte = |b: u8| f32::from(b) / 255.0;
    match &image.pixels {
        ImagePixels::Gray8(p) => Box::new(p.iter().map(move |g| [byte(*g), byte(*g), byte(*g), 1.0])),
        ImagePixels::Gray16(p) => Box::new(p.iter().map(|g| f32::from(*g) / 65_535.0).map(|g| [g, g, g, 1.0])),
        ImagePixels::Rgb8(p) => Box::new(p.iter().map(move |p| p.map(byte)).map(|[r, g, b]| [r, g, b, 1.0])),
        ImagePixels::Rgba8(p) => Box::new(p.iter().map(move |p| p.map(byte))),
        ImagePixels::Rgb32F(p) => Box::new(p.iter().map(|[r, g, b]| [*r, *g, *b, 1.0])),
        ImagePixels::Rgba32F(p) => Box::new(p.iter().copied()),
    }
}

/// Returns true if any pixel is not opaque.
pub(in crate::mesh) fn has_opacity(image: &ImageAsset) -> bool {
    matches!(image.pixels, ImagePixels::Rgba8(_) | ImagePixels::Rgba32F(_)) && pixels(image).any(|p| p[3] < 1.0)
}

/// Decoded colours times a factor.
pub(in crate::mesh) fn tinted(image: &ImageAsset, factor: [f64; 3]) -> ImageAsset {
    let tint = |[r, g, b, _]: [f32; 4]| {
        let linear = [r, g, b].map(colour::decode);
        std::array::from_fn(|i| (linear[i] * factor[i] as f32).clamp(0.0, 1.0))
    };
    with_pixels(image, ImagePixels::Rgb32F(pixels(image).map(tint).collect()))
}

/// Numbers of one channel, by a rule.
pub(in crate::mesh) fn channel(image: &ImageAsset, channel: usize, rule: impl Fn(f32) -> f32) -> ImageAsset {
    numbers(image, |pixel| rule(pixel[channel]))
}

/// Numbers from red, green, blue and opacity, by a rule.
pub(in crate::mesh) fn numbers(image: &ImageAsset, rule: impl Fn([f32; 4]) -> f32) -> ImageAsset {
    let number = |pixel: [f32; 4]| (rule(pixel).clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16;
    with_pixels(image, ImagePixels::Gray16(pixels(image).map(number).collect()))
}

/// Mean red, green and blue.
pub(in crate::mesh) fn mean(image: &ImageAsset) -> [f64; 3] {
    let sum = pixels(image).fold([0.0; 3], |sum, p| [0, 1, 2].map(|i| sum[i] + f64::from(p[i])));
    sum.map(|v| v / image.pixels.len().max(1) as f64)
}

/// Value of a constant image; `None` if values differ.
pub(in crate::mesh) fn only_value(image: &ImageAsset) -> Option<f64> {
    let ImagePixels::Gray16(numbers) = &image.pixels else { return None };
    let first = numbers.first()?;
    numbers.iter().all(|n| n == first).then(|| f64::from(*first) / 65_535.0)
}

fn with_pixels(image: &ImageAsset, pixels: ImagePixels) -> ImageAsset {
    ImageAsset {
        width: image.width,
        height: image.height,
        pixels,
        to_rec_709: None,
        hash: hash::hash_bytes(&image.hash),
    }
}
