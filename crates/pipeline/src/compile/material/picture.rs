//! Images as textures, each made once per layout.

use super::super::context::{Context, ErrorCode};
use super::large_picture::{TexelUse, TilingError, texture_in_memory, tiled_texture};
use super::texels::TexelInterpretation;
use etendue_scene::asset::{Assets, LargeImage, TexelStore};
use etendue_scene::{Place, Problem};
use etendue_tracer::textures::{ImageTexture, Sampling, TextureId, TileMemory};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Textures, with the file, interpretation and layout of each.
#[derive(Default)]
pub(super) struct Pictures {
    textures: Vec<ImageTexture>,
    ids: BTreeMap<(PathBuf, String), TextureId>,
    /// Memory of the tiles of all large images, once there are any.
    tile_memory: Option<Arc<TileMemory>>,
}

impl Pictures {
    /// An image named by a mesh's own file: sRGB-encoded colours that repeat.
    pub(super) fn slot_texture(&mut self, file: &Path, place: &Place, context: &mut Context<'_>) -> Option<TextureId> {
        let reading = TexelInterpretation { encoded: true, alpha: false, colour: true, scale: 1.0 };
        self.picture(file, place, reading, Sampling::default(), context)
    }

    /// Textures in the order of their ids.
    pub(super) fn into_textures(self) -> Vec<ImageTexture> {
        self.textures
    }

    /// An image with an interpretation and layout; `place` names it.
    pub(super) fn picture(
        &mut self,
        file: &Path,
        place: &Place,
        reading: TexelInterpretation,
        sampling: Sampling,
        context: &mut Context<'_>,
    ) -> Option<TextureId> {
        let key = (file.to_owned(), format!("{reading:?} {sampling:?}"));
        if let Some(id) = self.ids.get(&key) {
            return Some(*id);
        }
        let texture = self.texture(file, place, TexelUse { reading, sampling }, context)?;
        self.textures.push(texture);
        let id = TextureId((self.textures.len() - 1) as u32);
        self.ids.insert(key, id);
        Some(id)
    }

    fn texture(
        &mut self,
        file: &Path,
        place: &Place,
        usage: TexelUse,
        context: &mut Context<'_>,
    ) -> Option<ImageTexture> {
        let TexelUse { reading, sampling } = usage;
        let Assets { images, large_images, texel_store, .. } = context.assets;
        if let (Some(image), Some(store)) = (large_images.get(file), texel_store) {
            if reading.alpha && !image.format.has_opacity() {
                return no_opacity(file, place, context);
            }
            return self.large(file, image, place, usage, store, context);
        }
        let Some(image) = images.get(file) else {
            context.error(
                ErrorCode::UnreadableFile,
                place,
                format!("the image {} was not loaded", file.display()),
                "give a readable file",
            );
            return None;
        };
        let Some(texels) = reading.texels(&image.pixels, image.to_rec_709) else {
            return no_opacity(file, place, context);
        };
        context.accept(place, ImageTexture::new(image.width, image.height, texels, sampling))
    }

    /// In tiles; in memory if these cannot be stored.
    fn large(
        &mut self,
        file: &Path,
        image: &LargeImage,
        place: &Place,
        usage: TexelUse,
        store: &TexelStore,
        context: &mut Context<'_>,
    ) -> Option<ImageTexture> {
        let memory = self.tile_memory.get_or_insert_with(|| Arc::new(TileMemory::new(store.memory_bytes)));
        let texture = match tiled_texture(image, usage, store, memory) {
            Ok(texture) => Ok(texture),
            Err(TilingError::Picture(error)) => Err(error),
            Err(TilingError::Store(error)) => {
                let texture = texture_in_memory(image, usage);
                let megabytes = texture.as_ref().map_or(0, |texture| texture.texel_bytes().div_ceil(1_000_000));
                let problem = format!(
                    "{megabytes} MB are stored in memory, above its limit, because {error}; give a `cache` folder"
                );
                context.warn_on(file.display(), problem);
                texture
            }
        };
        context.accept(place, texture.map_err(|error| Problem::new(ErrorCode::UnsuitableFile, error)))
    }
}

fn no_opacity<T>(file: &Path, place: &Place, context: &mut Context<'_>) -> Option<T> {
    let problem = format!("the image {} has no opacity", file.display());
    context.error(
        ErrorCode::UnsuitableFile,
        place,
        problem,
        "give a PNG or EXR with an alpha channel, or name another channel",
    );
    None
}
