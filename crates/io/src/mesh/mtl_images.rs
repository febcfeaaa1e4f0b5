//! Images that the materials of an OBJ file name: found, and read where numbers are made from them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue_scene::asset::{ImageAsset, SlotNumber, SlotPicture, SlotWrap};
use etendue_scene::limits;

use super::derived_image::{has_opacity, mean, numbers, only_value};
use super::texture_option::TextureReference;
use crate::named_file::{NamedFile, find_named_file};
use crate::picture::read_image;
use crate::{Error, Sandbox, hash::ContentHash};

/// Images of the materials of one mesh.
pub(super) struct MtlImages<'a> {
    sandbox: &'a Sandbox,
    /// Folder of the mesh.
    mesh_folder: &'a Path,
    /// Images as read; `None` for unreadable ones.
    read: BTreeMap<PathBuf, Option<ImageAsset>>,
    /// Images derived from them, by name.
    pub(super) derived: BTreeMap<PathBuf, ImageAsset>,
    unpacked: u64,
}

/// Image of a number over the surface.
#[derive(Clone, Copy)]
struct NumberRule {
    name: &'static str,
    /// Factor on the number.
    factor: f64,
    is_squared: bool,
    /// True if the opacity of the image is the number, if it has one.
    prefers_opacity: bool,
}

impl<'a> MtlImages<'a> {
    pub(super) fn new(mesh_folder: &'a Path, sandbox: &'a Sandbox) -> Self {
        Self { sandbox, mesh_folder, read: BTreeMap::new(), derived: BTreeMap::new(), unpacked: 0 }
    }

    /// Hashes of the contents of the images that were read.
    pub(super) fn hashes(&self) -> impl Iterator<Item = ContentHash> {
        self.read.values().flatten().map(|image| image.hash)
    }

    /// The file of a texture that the library in `folder` names; a note if it has another path.
    pub(super) fn find(&self, folder: &Path, texture: &TextureReference, notes: &mut Vec<String>) -> PathBuf {
        match find_named_file(&[folder, self.mesh_folder], &texture.file, self.sandbox) {
            Ok(NamedFile { path, note, .. }) => {
                notes.extend(note);
                path
            }
            // A path outside the sandbox is refused where the image is read.
            Err(_) => folder.join(texture.file.replace('\\', "/")),
        }
    }

    /// `map_d`; `opacity` is `d`.
    pub(super) fn opacity(
        &mut self,
        path: &Path,
        texture: &TextureReference,
        opacity: Option<f64>,
    ) -> Result<SlotNumber, Error> {
        // Writers set `d` to 0 for "see the image".
        let factor = opacity.filter(|d| *d > 0.0).unwrap_or(1.0);
        self.number(path, texture, NumberRule { name: "opacity", factor, is_squared: false, prefers_opacity: true })
    }

    /// Squares of `map_Pr`.
    pub(super) fn alpha(&mut self, path: &Path, texture: &TextureReference) -> Result<SlotNumber, Error> {
        self.number(path, texture, NumberRule { name: "alpha", factor: 1.0, is_squared: true, prefers_opacity: false })
    }

    /// `map_Pm`.
    pub(super) fn metal(&mut self, path: &Path, texture: &TextureReference) -> Result<SlotNumber, Error> {
        self.number(path, texture, NumberRule { name: "metal", factor: 1.0, is_squared: false, prefers_opacity: false })
    }

    /// Number of an image by a rule; an unreadable image stands for itself, so that it is refused where the material is used.
    fn number(&mut self, path: &Path, texture: &TextureReference, rule: NumberRule) -> Result<SlotNumber, Error> {
        let channel = texture.channel.clone();
        let Some(image) = self.image(path)? else { return Ok(SlotNumber::Picture(picture(path, false))) };
        let channel = match channel.as_deref() {
            None if rule.prefers_opacity && has_opacity(image) => "m",
            None => "l",
            Some(channel) => channel,
        };
        let value = |[r, g, b, a]: [f32; 4]| match channel {
            "r" => r,
            "g" => g,
            "b" => b,
            "m" => a,
            _ => (r + g + b) / 3.0,
        };
        let NumberRule { name, factor, is_squared, .. } = rule;
        let scaled = |v: f32| if is_squared { v * v } else { v * factor as f32 };
        let derived = numbers(image, |pixel| scaled(value(pixel)));
        if let Some(constant) = only_value(&derived) {
            return Ok(SlotNumber::Number(constant));
        }
        let key = PathBuf::from(format!("{}#{name} {channel} {factor}", path.display()));
        self.count(&derived).map_err(|problem| Error::new(path, problem))?;
        self.derived.insert(key.clone(), derived);
        Ok(SlotNumber::Picture(picture(&key, true)))
    }

    /// `norm`: a normal map as it is.
    pub(super) fn normals(path: &Path, texture: &TextureReference) -> (SlotPicture, f64) {
        (picture(path, false), texture.strength())
    }

    /// A bump map that is a normal map in fact; `None` for heights, whose unit no file states.
    pub(super) fn bump(
        &mut self,
        path: &Path,
        texture: &TextureReference,
    ) -> Result<Option<(SlotPicture, f64)>, Error> {
        let Some(image) = self.image(path)? else { return Ok(None) };
        let [r, g, b] = mean(image);
        // Means of tangent-space normals: x and y about 0, z near 1.
        let is_normals = (0.4..0.6).contains(&r) && (0.4..0.6).contains(&g) && b > 0.75;
        Ok(is_normals.then(|| (picture(path, false), texture.strength())))
    }

    fn image(&mut self, path: &Path) -> Result<Option<&ImageAsset>, Error> {
        if !self.read.contains_key(path) {
            let image = self.sandbox.check(path).ok().and_then(|()| read_image(path).ok());
            if let Some(image) = &image {
                self.count(image).map_err(|problem| Error::new(path, problem))?;
            }
            self.read.insert(path.to_owned(), image);
        }
        Ok(self.read.get(path).and_then(Option::as_ref))
    }

    /// Limits the total size of all images: materials may make many from one.
    fn count(&mut self, image: &ImageAsset) -> Result<(), crate::Problem> {
        const BYTES_PER_PIXEL: u64 = 16;
        let bytes = u64::from(image.width) * u64::from(image.height) * BYTES_PER_PIXEL;
        self.unpacked = self.unpacked.saturating_add(bytes);
        limits::MESH.check_unpacked(self.unpacked)
    }
}

fn picture(file: &Path, is_embedded: bool) -> SlotPicture {
    SlotPicture { file: file.to_owned(), is_embedded, is_encoded: false, wrap: [SlotWrap::Repeat; 2] }
}
