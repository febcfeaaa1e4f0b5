//! Images of a glTF file, and their texture coordinates.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue_core::maths::f64 as maths;
use etendue_scene::asset::{ImageAsset, SlotPicture, SlotWrap};
use etendue_scene::limits;
use gltf::json::texture::{Info, WrappingMode};
use gltf::{json::Root, json::validation::Checked};

use super::buffers::{Buffers, LinkedBytes, linked};
use super::compression;
use crate::{Problem, Sandbox, picture::decode_image};

/// Texture as used by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TextureUse {
    pub(super) texture: usize,
    pub(super) layout: UvLayout,
}

/// Set of texture coordinates of an image, and their transform (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvLayout {
    pub(super) set: u32,
    pub(super) offset: [f64; 2],
    /// Rotation, rad.
    pub(super) rotation: f64,
    pub(super) scale: [f64; 2],
}

impl UvLayout {
    pub(super) const PLAIN: Self = Self { set: 0, offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2] };

    /// Converts texture coordinates of the file (v downwards) to those of a mesh (v upwards).
    pub(super) fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = maths::sin_cos(self.rotation);
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        [cos * u + sin * v + self.offset[0], 1.0 - (cos * v - sin * u + self.offset[1])]
    }
}

impl TextureUse {
    pub(super) fn new(info: &Info) -> Self {
        let mut layout = UvLayout { set: info.tex_coord, ..UvLayout::PLAIN };
        if let Some(transform) = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) {
            layout = UvLayout {
                set: transform.tex_coord.unwrap_or(layout.set),
                offset: transform.offset.0.map(f64::from),
                rotation: f64::from(transform.rotation.0),
                scale: transform.scale.0.map(f64::from),
            };
        }
        Self { texture: info.index.value(), layout }
    }
}

/// Images as read, each once, and images made from them.
pub(super) struct GltfImages<'a> {
    file: &'a Path,
    root: &'a Root,
    buffers: &'a Buffers,
    sandbox: &'a Sandbox,
    images: BTreeMap<usize, ImageAsset>,
    /// Images that materials use, by name.
    pub(super) used: BTreeMap<PathBuf, ImageAsset>,
    /// Bytes of image files, in the order of reading.
    pub(super) files: Vec<Vec<u8>>,
    /// Differences between URIs and files.
    pub(super) notes: Vec<String>,
    unpacked: u64,
}

impl<'a> GltfImages<'a> {
    pub(super) fn new(file: &'a Path, root: &'a Root, buffers: &'a Buffers, sandbox: &'a Sandbox) -> Self {
        Self {
            file,
            root,
            buffers,
            sandbox,
            images: BTreeMap::new(),
            used: BTreeMap::new(),
            files: Vec::new(),
            notes: Vec::new(),
            unpacked: 0,
        }
    }

    /// Image of a texture, as in the file.
    pub(super) fn image(&mut self, texture: usize) -> Result<&ImageAsset, Problem> {
        let number = self.image_of(texture)?;
        if !self.images.contains_key(&number) {
            let image = self.read(number)?;
            self.count(&image)?;
            self.images.insert(number, image);
        }
        Ok(&self.images[&number])
    }

    /// The same image for a material.
    pub(super) fn original(&mut self, texture: usize, is_encoded: bool) -> Result<SlotPicture, Problem> {
        let number = self.image_of(texture)?;
        let image = self.image(texture)?.clone();
        let name = PathBuf::from(format!("{}#image {number}", self.file.display()));
        self.keep(name, image, texture, is_encoded)
    }

    /// Image made from that image; `what` describes the operation in words that no other has.
    pub(super) fn derived(
        &mut self,
        texture: usize,
        what: &str,
        is_encoded: bool,
        make: impl FnOnce(&ImageAsset) -> ImageAsset,
    ) -> Result<SlotPicture, Problem> {
        let number = self.image_of(texture)?;
        let name = PathBuf::from(format!("{}#image {number}, {what}", self.file.display()));
        let derived = match self.used.get(&name) {
            Some(_) => None,
            None => Some(make(self.image(texture)?)),
        };
        match derived {
            Some(image) => self.keep(name, image, texture, is_encoded),
            None => Ok(SlotPicture { file: name, is_embedded: true, is_encoded, wrap: self.wrap(texture) }),
        }
    }

    fn keep(
        &mut self,
        name: PathBuf,
        image: ImageAsset,
        texture: usize,
        is_encoded: bool,
    ) -> Result<SlotPicture, Problem> {
        if !self.used.contains_key(&name) {
            self.count(&image)?;
            self.used.insert(name.clone(), image);
        }
        Ok(SlotPicture { file: name, is_embedded: true, is_encoded, wrap: self.wrap(texture) })
    }

    fn image_of(&self, texture: usize) -> Result<usize, Problem> {
        let entry = self.root.textures.get(texture).ok_or_else(|| format!("texture {texture} does not exist"))?;
        compression::image_of(texture, entry)
    }

    /// Limits the total size of all images: materials may make many from one.
    fn count(&mut self, image: &ImageAsset) -> Result<(), Problem> {
        const BYTES_PER_PIXEL: u64 = 16;
        self.unpacked =
            self.unpacked.saturating_add(u64::from(image.width) * u64::from(image.height) * BYTES_PER_PIXEL);
        limits::MESH.check_unpacked(self.unpacked)
    }

    fn read(&mut self, number: usize) -> Result<ImageAsset, Problem> {
        let image = self.root.images.get(number).ok_or_else(|| format!("image {number} does not exist"))?;
        let what = format!("image {number}");
        let LinkedBytes { bytes, path, note } = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => linked(self.file, uri, &what, self.sandbox)?,
            (None, Some(view)) => {
                let view = self
                    .root
                    .buffer_views
                    .get(view.value())
                    .ok_or_else(|| format!("{what} refers to a buffer view that does not exist"))?;
                let bytes = self.buffers.view(view).map_err(|problem| format!("{what} refers to {problem}"))?.to_vec();
                LinkedBytes { bytes, path: None, note: None }
            }
            (None, None) => return Err(format!("{what} has neither \"uri\" nor \"bufferView\"").into()),
        };
        if bytes.is_empty() {
            return Err(format!("{what} is empty").into());
        }
        let decoded = decode_image(Path::new(&what), &bytes).map_err(|error| error.to_string())?;
        self.notes.extend(note);
        if path.is_some() {
            self.files.push(bytes);
        }
        Ok(decoded)
    }

    fn wrap(&self, texture: usize) -> [SlotWrap; 2] {
        let sampler =
            self.root.textures.get(texture).and_then(|t| t.sampler).and_then(|s| self.root.samplers.get(s.value()));
        let wrap_of = |mode: &Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::ClampToEdge) => SlotWrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => SlotWrap::Mirror,
            Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => SlotWrap::Repeat,
        };
        sampler.map_or([SlotWrap::Repeat; 2], |s| [wrap_of(&s.wrap_s), wrap_of(&s.wrap_t)])
    }
}
