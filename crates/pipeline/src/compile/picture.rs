//! Images of a file as numbers: grey values as in the file, and linear colours.

use super::context::{Context, ErrorCode};
use etendue_scene::Placed;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_spectra::colour;
use std::path::PathBuf;

/// Width and numbers, row by row, of an image: bytes and words over their maximum, floating-point numbers unchanged; the mean of the channels.
pub(super) fn grey(file: &Placed<PathBuf>, context: &mut Context<'_>) -> Option<(usize, Vec<f32>)> {
    let Some(image) = context.assets.images.get(&file.value) else {
        let problem = format!("the image {} was not loaded", file.value.display());
        context.error(ErrorCode::UnreadableFile, &file.place, problem, "give a readable file");
        return None;
    };
    Some((image.width as usize, numbers(image)))
}

fn numbers(image: &ImageAsset) -> Vec<f32> {
    let byte = |v: u8| f32::from(v) / 255.0;
    let mean = |p: [f32; 3]| (p[0] + p[1] + p[2]) / 3.0;
    match &image.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|v| byte(*v)).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|v| f32::from(*v) / 65_535.0).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|p| mean(p.map(byte))).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|[r, g, b, _]| mean([*r, *g, *b].map(byte))).collect(),
        ImagePixels::Rgb32F(p) => p.iter().map(|p| mean(*p)).collect(),
        ImagePixels::Rgba32F(p) => p.iter().map(|[r, g, b, _]| mean([*r, *g, *b])).collect(),
    }
}

/// Linear sRGB of an image; bytes are interpreted as sRGB-encoded.
pub(super) fn linear(image: &ImageAsset) -> Vec<[f32; 3]> {
    let colour = |p: [f32; 3]| image.to_rec_709.map_or(p, |matrix| matrix.apply(p));
    match &image.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|g| [colour::decode_byte(*g); 3]).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|g| [f32::from(*g) / 65_535.0; 3]).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|c| c.map(colour::decode_byte)).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|[r, g, b, _]| [*r, *g, *b].map(colour::decode_byte)).collect(),
        ImagePixels::Rgb32F(p) => p.iter().map(|p| colour(*p)).collect(),
        ImagePixels::Rgba32F(p) => p.iter().map(|[r, g, b, _]| colour([*r, *g, *b])).collect(),
    }
}
