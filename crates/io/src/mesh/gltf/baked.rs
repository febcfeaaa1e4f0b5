//! Pictures made of others: channels, squares, factors.

use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_spectra::colour;

use crate::hash;

/// Red, green, blue, opacity of every pixel as numbers 0 … 1 (more, of floats), as the file has them.
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

/// Whether any pixel lets light through.
pub(super) fn has_opacity(image: &ImageAsset) -> bool {
    matches!(image.pixels, ImagePixels::Rgba8(_) | ImagePixels::Rgba32F(_)) && pixels(image).any(|p| p[3] < 1.0)
}

/// Colours times a factor, decoded.
pub(super) fn tinted(image: &ImageAsset, factor: [f64; 3]) -> ImageAsset {
    let tint = |[r, g, b, _]: [f32; 4]| {
        let linear = [r, g, b].map(colour::decode);
        std::array::from_fn(|i| (linear[i] * factor[i] as f32).clamp(0.0, 1.0))
    };
    of(image, ImagePixels::Rgb32F(pixels(image).map(tint).collect()))
}

/// Numbers from one channel, by a rule.
pub(super) fn channel(image: &ImageAsset, channel: usize, rule: impl Fn(f32) -> f32) -> ImageAsset {
    let number = |p: [f32; 4]| (rule(p[channel]).clamp(0.0, 1.0) * 65_535.0 + 0.5) as u16;
    of(image, ImagePixels::Gray16(pixels(image).map(number).collect()))
}

/// The only value of such numbers; `None` where they differ.
pub(super) fn only_value(image: &ImageAsset) -> Option<f64> {
    let ImagePixels::Gray16(numbers) = &image.pixels else { return None };
    let first = numbers.first()?;
    numbers.iter().all(|n| n == first).then(|| f64::from(*first) / 65_535.0)
}

fn of(image: &ImageAsset, pixels: ImagePixels) -> ImageAsset {
    ImageAsset { width: image.width, height: image.height, pixels, to_rec_709: None, hash: hash::of_bytes(&image.hash) }
}
