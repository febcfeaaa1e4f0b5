//! Textures of images that are too large for memory: in tiles, which are made once for all runs.

use super::texels::TexelInterpretation;
use etendue_core::storage::{BlockKey, BlockWriter};
use etendue_scene::asset::{LargeImage, TexelStore};
use etendue_tracer::textures::{ImageTexture, PyramidWriter, Sampling, Texels, TextureError, TileMemory, TiledError};
use sha2::{Digest as _, Sha256};
use std::sync::Arc;

/// Increased whenever the same image gives other tiles.
const TILES_REVISION: u32 = 1;

/// Reasons for which an image is not in tiles.
#[derive(Debug, PartialEq)]
pub(super) enum TilingError {
    /// The image or its layout is invalid.
    Picture(String),
    /// Its tiles cannot be stored.
    Store(String),
}

/// Interpretation of an image's texels, their layout and their lookup.
#[derive(Clone, Copy)]
pub(super) struct TexelUse {
    pub(super) reading: TexelInterpretation,
    pub(super) sampling: Sampling,
}

/// A texture with tiles in the store; makes the tiles if they are missing.
pub(super) fn tiled_texture(
    image: &LargeImage,
    usage: TexelUse,
    store: &TexelStore,
    memory: &Arc<TileMemory>,
) -> Result<ImageTexture, TilingError> {
    let TexelUse { reading, sampling } = usage;
    let encoding = reading.encoding(image.format);
    let (key, lengths) = (key(image, reading), PyramidWriter::lengths(image.width, image.height, encoding));
    let texture = |blocks| ImageTexture::tiled(image.width, image.height, encoding, blocks, memory, sampling);
    match store.blocks.find(&key, &lengths).map(texture) {
        Some(Ok(texture)) => return Ok(texture),
        Some(Err(TiledError::Texture(error))) => return Err(TilingError::Picture(error.to_string())),
        // The stored tiles are damaged: they are made again.
        Some(Err(TiledError::Tiles(_))) | None => {}
    }
    store.blocks.check_room(&key, &lengths).map_err(TilingError::Picture)?;
    let mut tile_error = None;
    let store_result = store.blocks.make(&key, &lengths, &mut |out| {
        write_tiles(image, reading, out).map_err(|refusal| match refusal {
            TilingError::Store(error) => error,
            TilingError::Picture(error) => tile_error.insert(error).clone(),
        })
    });
    match (store_result, tile_error) {
        (_, Some(error)) => Err(TilingError::Picture(error)),
        (Err(error), None) => Err(TilingError::Store(error)),
        (Ok(blocks), None) => texture(blocks).map_err(tiling_error),
    }
}

/// The whole image in memory.
pub(super) fn texture_in_memory(image: &LargeImage, usage: TexelUse) -> Result<ImageTexture, String> {
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
        all.ok_or_else(|| TextureError::Size { width: image.width, height: image.height, actual: 0 }.to_string())?;
    ImageTexture::new(image.width, image.height, texels, sampling).map_err(|error| error.to_string())
}

/// Everything that determines the tiles.
fn key(image: &LargeImage, TexelInterpretation { encoded, alpha, colour, scale }: TexelInterpretation) -> BlockKey {
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
fn write_tiles(image: &LargeImage, reading: TexelInterpretation, out: &mut dyn BlockWriter) -> Result<(), TilingError> {
    let writer = PyramidWriter::new(image.width, image.height, reading.encoding(image.format));
    let mut writer = writer.map_err(|error| TilingError::Picture(error.to_string()))?;
    let mut write_error = None;
    let read = image.rows.read(&mut |rows| {
        let texels = reading.texels(rows, image.to_rec_709).ok_or_else(no_opacity)?;
        let pushed = writer.push(&texels, out);
        pushed.map_err(|error| write_error.insert(tiling_error(error)).to_string())
    });
    match (read, write_error) {
        (_, Some(write_error)) => Err(write_error),
        (Err(error), None) => Err(TilingError::Picture(error)),
        (Ok(()), None) => writer.finish(out).map_err(tiling_error),
    }
}

fn tiling_error(error: TiledError) -> TilingError {
    match error {
        TiledError::Texture(error) => TilingError::Picture(error.to_string()),
        TiledError::Tiles(error) => TilingError::Store(error),
    }
}

fn no_opacity() -> String {
    "the image has no opacity".to_owned()
}

impl std::fmt::Display for TilingError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (Self::Picture(text) | Self::Store(text)) = self;
        f.write_str(text)
    }
}
