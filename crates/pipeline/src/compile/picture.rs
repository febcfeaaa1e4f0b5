//! Pictures of plain numbers: grey, and as they stand in the file.

use super::context::Context;
use etendue_scene::Placed;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use std::path::PathBuf;

/// Width and numbers, row by row, of a picture: bytes and words over their largest, floating-point numbers as they are; the
/// mean of the channels.
pub(super) fn grey(file: &Placed<PathBuf>, context: &mut Context<'_>) -> Option<(usize, Vec<f32>)> {
    let Some(image) = context.assets.images.get(&file.value) else {
        let problem = format!("the picture {} was not loaded", file.value.display());
        context.fault(&file.place, problem, "give a readable file");
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
