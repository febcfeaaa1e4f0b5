//! The texels of a picture as linear colours.

use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_spectra::colour;

/// Linear sRGB of a picture; bytes are taken as sRGB-encoded.
pub(super) fn linear(picture: &ImageAsset) -> Vec<[f32; 3]> {
    let colour = |p: [f32; 3]| picture.to_rec_709.map_or(p, |matrix| matrix.apply(p));
    match &picture.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|g| [colour::decode_byte(*g); 3]).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|g| [f32::from(*g) / 65_535.0; 3]).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|c| c.map(colour::decode_byte)).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|[r, g, b, _]| [*r, *g, *b].map(colour::decode_byte)).collect(),
        ImagePixels::Rgb32F(p) => p.iter().map(|p| colour(*p)).collect(),
        ImagePixels::Rgba32F(p) => p.iter().map(|[r, g, b, _]| colour([*r, *g, *b])).collect(),
    }
}
