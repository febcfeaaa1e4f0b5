//! Pictures as textures, each made once for every way in which it is laid out.

use super::super::context::Context;
use etendue_scene::Place;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_spectra::colour;
use etendue_tracer::textures::{ImageTexture, Sampling, Texels, TextureId};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// How a picture becomes texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reading {
    /// The numbers are encoded by the curve of sRGB.
    pub(super) encoded: bool,
    /// The opacity is read in place of the colours.
    pub(super) alpha: bool,
    /// A factor on the numbers.
    pub(super) scale: f32,
}

/// Textures, and by what file, reading and layout each was made.
#[derive(Default)]
pub(super) struct Pictures {
    textures: Vec<ImageTexture>,
    made: BTreeMap<(PathBuf, String), TextureId>,
}

impl Pictures {
    /// A picture that a mesh's own file names: sRGB-encoded colours that repeat.
    pub(super) fn of_slot(&mut self, file: &Path, place: &Place, context: &mut Context<'_>) -> Option<TextureId> {
        let reading = Reading { encoded: true, alpha: false, scale: 1.0 };
        self.picture(file, place, reading, Sampling::default(), context)
    }

    /// The textures in the order of their ids.
    pub(super) fn into_textures(self) -> Vec<ImageTexture> {
        self.textures
    }

    /// A picture read and laid out in a way; `place` names it.
    pub(super) fn picture(
        &mut self,
        file: &Path,
        place: &Place,
        reading: Reading,
        sampling: Sampling,
        context: &mut Context<'_>,
    ) -> Option<TextureId> {
        let key = (file.to_owned(), format!("{reading:?} {sampling:?}"));
        if let Some(id) = self.made.get(&key) {
            return Some(*id);
        }
        let Some(image) = context.assets.images.get(file) else {
            context.fault(place, format!("the picture {} was not loaded", file.display()), "give a readable file");
            return None;
        };
        let texels = if reading.alpha { opacity(image, reading.scale) } else { Some(texels(image, reading)) };
        let Some(texels) = texels else {
            let problem = format!("the picture {} has no opacity to read", file.display());
            context.fault(place, problem, "give a PNG or EXR with an alpha channel, or name another channel");
            return None;
        };
        let made = ImageTexture::new(image.width, image.height, texels, sampling);
        self.textures.push(context.accept(place, made)?);
        let id = TextureId((self.textures.len() - 1) as u32);
        self.made.insert(key, id);
        Some(id)
    }
}

/// The picture's colours as the tracer keeps them; a factor other than 1 needs them as linear numbers.
fn texels(image: &ImageAsset, Reading { encoded, scale, .. }: Reading) -> Texels {
    let bytes = |pixels: Vec<[u8; 3]>| match (encoded, scale == 1.0) {
        (true, true) => Texels::Srgb8(pixels),
        (false, true) => Texels::Linear8(pixels),
        (true, false) => floats(&pixels, |b| colour::decode_byte(b) * scale),
        (false, false) => floats(&pixels, |b| f32::from(b) / 255.0 * scale),
    };
    let linear = |v: f32| if encoded { colour::decode(v) } else { v };
    let scaled = |p: [f32; 3]| p.map(|v| linear(v) * scale);
    match &image.pixels {
        ImagePixels::Gray8(pixels) => bytes(pixels.iter().map(|g| [*g; 3]).collect()),
        ImagePixels::Gray16(pixels) => {
            Texels::Float(pixels.iter().map(|g| scaled([f32::from(*g) / 65_535.0; 3])).collect())
        }
        ImagePixels::Rgb8(pixels) => bytes(pixels.clone()),
        ImagePixels::Rgba8(pixels) => bytes(pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()),
        ImagePixels::Rgb32F(pixels) => Texels::Float(pixels.iter().map(|p| scaled(*p)).collect()),
        ImagePixels::Rgba32F(pixels) => Texels::Float(pixels.iter().map(|[r, g, b, _]| scaled([*r, *g, *b])).collect()),
    }
}

/// The picture's opacity as a grey picture; `None` where it has none. Opacity is linear in every file.
fn opacity(image: &ImageAsset, scale: f32) -> Option<Texels> {
    match &image.pixels {
        ImagePixels::Rgba8(pixels) => {
            let bytes: Vec<_> = pixels.iter().map(|[_, _, _, a]| [*a; 3]).collect();
            Some(if scale == 1.0 { Texels::Linear8(bytes) } else { floats(&bytes, |b| f32::from(b) / 255.0 * scale) })
        }
        ImagePixels::Rgba32F(pixels) => {
            Some(Texels::Float(pixels.iter().map(|[_, _, _, a]| [*a * scale; 3]).collect()))
        }
        ImagePixels::Gray8(_) | ImagePixels::Gray16(_) | ImagePixels::Rgb8(_) | ImagePixels::Rgb32F(_) => None,
    }
}

fn floats(pixels: &[[u8; 3]], linear: impl Fn(u8) -> f32) -> Texels {
    Texels::Float(pixels.iter().map(|p| p.map(&linear)).collect())
}
