//! Textures of images that are too large for memory: in tiles, which are made once for all runs.

use super::texels::Reading;
use etendue_core::storage::{BlockKey, BlockWriter};
use etendue_scene::asset::{LargeImage, TexelStore};
use etendue_tracer::textures::{ImageTexture, PyramidWriter, Sampling, Texels, TextureError, TileMemory, TiledError};
use sha2::{Digest as _, Sha256};
use std::sync::Arc;

/// Increased whenever the same image gives other tiles.
const TILES_REVISION: u32 = 1;

/// Reasons for which an image is not in tiles.
#[derive(Debug, PartialEq)]
pub(super) enum Refusal {
    /// The image or its layout is invalid.
    Picture(String),
    /// Its tiles cannot be stored.
    Store(String),
}

/// Interpretation of an image's texels, their layout and their lookup.
#[derive(Clone, Copy)]
pub(super) struct TexelUse {
    pub(super) reading: Reading,
    pub(super) sampling: Sampling,
}

/// A texture with tiles in the store; makes the tiles if they are missing.
pub(super) fn tiled(
    image: &LargeImage,
    usage: TexelUse,
    store: &TexelStore,
    memory: &Arc<TileMemory>,
) -> Result<ImageTexture, Refusal> {
    let TexelUse { reading, sampling } = usage;
    let encoding = reading.encoding(image.format);
    let (key, lengths) = (key(image, reading), PyramidWriter::lengths(image.width, image.height, encoding));
    let texture = |blocks| ImageTexture::tiled(image.width, image.height, encoding, blocks, memory, sampling);
    match store.blocks.find(&key, &lengths).map(texture) {
        Some(Ok(texture)) => return Ok(texture),
        Some(Err(TiledError::Texture(error))) => return Err(Refusal::Picture(error.to_string())),
        // The stored tiles are damaged: they are made again.
        Some(Err(TiledError::Tiles(_))) | None => {}
    }
    store.blocks.check_room(&key, &lengths).map_err(Refusal::Picture)?;
    let mut faulty = None;
    let made = store.blocks.make(&key, &lengths, &mut |out| {
        fill(image, reading, out).map_err(|refusal| match refusal {
            Refusal::Store(error) => error,
            Refusal::Picture(error) => faulty.insert(error).clone(),
        })
    });
    match (made, faulty) {
        (_, Some(error)) => Err(Refusal::Picture(error)),
        (Err(error), None) => Err(Refusal::Store(error)),
        (Ok(blocks), None) => texture(blocks).map_err(refusal),
    }
}

/// The whole image in memory.
pub(super) fn held(image: &LargeImage, usage: TexelUse) -> Result<ImageTexture, String> {
    let TexelUse { reading, sampling } = usage;
    let mut all: Option<Texels> = None;
    image.rows.read(&mut |rows| {
        let texels = reading.texels(rows, image.to_rec_709).ok_or_else(no_opacity)?;
        match &mut all {
            None => all = Some(texels),
            Some(all) => all.append(texels),
        }
        Ok(())
    })?;
    let texels =
        all.ok_or_else(|| TextureError::Size { width: image.width, height: image.height, found: 0 }.to_string())?;
    ImageTexture::new(image.width, image.height, texels, sampling).map_err(|error| error.to_string())
}

/// Everything that determines the tiles.
fn key(image: &LargeImage, Reading { encoded, alpha, colour, scale }: Reading) -> BlockKey {
    let mut hash = Sha256::new();
    hash.update(b"etendue texels");
    hash.update(TILES_REVISION.to_le_bytes());
    hash.update(image.hash);
    hash.update([u8::from(encoded), u8::from(alpha)]);
    hash.update(scale.to_le_bytes());
    for number in image.to_rec_709.filter(|_| colour).iter().flat_map(|matrix| matrix.0.as_flattened()) {
        hash.update(number.to_le_bytes());
    }
    hash.finalize().into()
}

/// Writes all tiles.
fn fill(image: &LargeImage, reading: Reading, out: &mut dyn BlockWriter) -> Result<(), Refusal> {
    let writer = PyramidWriter::new(image.width, image.height, reading.encoding(image.format));
    let mut writer = writer.map_err(|error| Refusal::Picture(error.to_string()))?;
    let mut refused = None;
    let read = image.rows.read(&mut |rows| {
        let texels = reading.texels(rows, image.to_rec_709).ok_or_else(no_opacity)?;
        let pushed = writer.push(&texels, out);
        pushed.map_err(|error| refused.insert(refusal(error)).to_string())
    });
    match (read, refused) {
        (_, Some(refused)) => Err(refused),
        (Err(error), None) => Err(Refusal::Picture(error)),
        (Ok(()), None) => writer.finish(out).map_err(refusal),
    }
}

fn refusal(error: TiledError) -> Refusal {
    match error {
        TiledError::Texture(error) => Refusal::Picture(error.to_string()),
        TiledError::Tiles(error) => Refusal::Store(error),
    }
}

fn no_opacity() -> String {
    "the image has no opacity".to_owned()
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (Self::Picture(text) | Self::Store(text)) = self;
        f.write_str(text)
    }
}
