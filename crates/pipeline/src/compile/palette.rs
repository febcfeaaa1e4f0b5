//! Materials and textures: from records and from the meshes' own files to the tracer's palette.

use super::context::Context;
use super::spectrum::{emitted, from_file};
use etendue_scene::asset::{ImageAsset, ImagePixels, SlotMaterial, SlotReflectance, SlotSurface};
use etendue_scene::record::texture::{self, Encoding};
use etendue_scene::record::{self, Scene, SurfaceEmission, material};
use etendue_scene::{Place, Placed};
use etendue_spectra::{Outside, Spectrum, colour, metal, upsample};
use etendue_tracer::MaterialId;
use etendue_tracer::materials::{Coated, Conductor, Emission, Glow, Material, Palette, Reflectance, Surface};
use etendue_tracer::textures::{ImageTexture, Sampling, Texels, TextureId, Wrap};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The index of a coat that does not state one.
const COAT_INDEX: f64 = 1.5;

/// Materials and textures as they are found, and where each was named.
#[derive(Default)]
pub(super) struct PaletteBuilder {
    materials: Vec<Material>,
    places: Vec<Place>,
    names: Vec<String>,
    by_name: BTreeMap<String, MaterialId>,
    /// Materials that meshes bring themselves, by mesh file and slot name.
    by_slot: BTreeMap<(PathBuf, String), MaterialId>,
    textures: Vec<ImageTexture>,
    by_picture: BTreeMap<PictureKey, TextureId>,
}

/// A picture laid out in one way: file, encoding is sRGB, wrap, bits of the factor.
type PictureKey = (PathBuf, bool, u8, u64);

impl PaletteBuilder {
    /// All materials of a scene.
    pub(super) fn of_scene(scene: &Scene, context: &mut Context<'_>) -> Self {
        let mut builder = Self::default();
        for record in &scene.materials {
            if let Some(material) = builder.material(record, scene, context) {
                let id = builder.add(material, record.place.clone(), record.name.value.clone());
                builder.by_name.insert(record.name.value.clone(), id);
            }
        }
        builder
    }

    /// The material of a name that the scene defines; `None` where it is faulty.
    pub(super) fn named(&self, name: &str) -> Option<MaterialId> {
        self.by_name.get(name).copied()
    }

    /// The name of a material that has a texture; `None` for one without.
    pub(super) fn textured(&self, id: MaterialId) -> Option<&str> {
        let textured = !self.materials[id.0 as usize].textures().is_empty();
        textured.then(|| self.names[id.0 as usize].as_str())
    }

    /// The material that a mesh's own file gives a slot. A fault at `place` where the file gives none.
    pub(super) fn of_slot(
        &mut self,
        file: &Path,
        slot: &SlotMaterial,
        place: &Place,
        context: &mut Context<'_>,
    ) -> Option<MaterialId> {
        let key = (file.to_owned(), slot.name.clone());
        if let Some(id) = self.by_slot.get(&key) {
            return Some(*id);
        }
        let Some(surface) = &slot.surface else {
            let problem = format!("{} says no reflectance for its material \"{}\"", file.display(), slot.name);
            let remedy = match slot.name.is_empty() {
                true => "name one of the scene's: material = …".to_owned(),
                false => format!("name one of the scene's: material = …, or materials = {{ \"{}\" = … }}", slot.name),
            };
            context.fault(place, problem, remedy);
            return None;
        };
        let surface = self.slot_surface(surface, place, context)?;
        let id = self.add(Material::new(surface), place.clone(), slot.name.clone());
        self.by_slot.insert(key, id);
        Some(id)
    }

    /// The palette, and the materials' names in the order of their ids.
    pub(super) fn finish(self, context: &mut Context<'_>) -> Option<(Palette, Vec<String>)> {
        match Palette::new(self.materials, self.textures) {
            Ok(palette) => Some((palette, self.names)),
            Err(error) => {
                if let Some(place) = error.material().and_then(|i| self.places.get(i)) {
                    context.fault(place, error.to_string(), "");
                }
                None
            }
        }
    }

    fn add(&mut self, material: Material, place: Place, name: String) -> MaterialId {
        self.materials.push(material);
        self.places.push(place);
        self.names.push(name);
        MaterialId((self.materials.len() - 1) as u32)
    }

    fn material(&mut self, record: &record::Material, scene: &Scene, context: &mut Context<'_>) -> Option<Material> {
        let surface = match &record.surface {
            material::Surface::Diffuse(r) => Surface::Diffuse(self.reflectance(&r.reflectance, scene, context)?),
            material::Surface::Conductor(r) => Surface::Conductor(Box::new(conductor(r, context)?)),
            material::Surface::Coated(r) => {
                let base = self.reflectance(&r.reflectance, scene, context)?;
                let index = r.index.as_ref().map_or(COAT_INDEX, |n| n.value);
                Surface::Coated(Box::new(context.accept(&r.place, Coated::new(base, index, r.alpha.value))?))
            }
            material::Surface::Emitter(_) => Surface::Absorber,
        };
        let emission = match &record.emission {
            Some(emission) => Some(self.emission(emission, scene, context)?),
            None => None,
        };
        Some(Material { emission, ..Material::new(surface) })
    }

    fn emission(&mut self, record: &SurfaceEmission, scene: &Scene, context: &mut Context<'_>) -> Option<Emission> {
        let glow = match record.sides.as_ref().map(|s| s.value) {
            Some(material::Sides::Both) => Glow::Both,
            Some(material::Sides::Front) | None => Glow::Front,
        };
        let factor = match &record.texture {
            Some(name) => Some(self.texture(named_texture(name, scene)?, None, context)?),
            None => None,
        };
        Some(Emission { radiance: emitted(&record.light, context)?, factor, glow })
    }

    fn reflectance(
        &mut self,
        reflectance: &record::Reflectance,
        scene: &Scene,
        context: &mut Context<'_>,
    ) -> Option<Reflectance> {
        let rgb = |rgb: [f64; 3]| Reflectance::Spectrum(upsample::reflectance_spectrum(rgb.map(|v| v as f32)));
        match reflectance {
            record::Reflectance::Grey(share) => Some(Reflectance::Spectrum(Spectrum::constant(share.value))),
            record::Reflectance::LinearSrgb(value) => Some(rgb(value.value)),
            record::Reflectance::EncodedSrgb(value) => {
                Some(rgb(value.value.map(|v| f64::from(colour::decode(v as f32)))))
            }
            record::Reflectance::Spectrum(file) => from_file(file, Outside::Hold, context).map(Reflectance::Spectrum),
            record::Reflectance::Texture { name, scale } => {
                self.texture(named_texture(name, scene)?, scale.as_ref(), context).map(Reflectance::Texture)
            }
        }
    }

    fn texture(
        &mut self,
        record: &record::Texture,
        scale: Option<&Placed<f64>>,
        context: &mut Context<'_>,
    ) -> Option<TextureId> {
        let wrap = match record.wrap.as_ref().map_or(texture::Wrap::Repeat, |w| w.value) {
            texture::Wrap::Repeat => Wrap::Repeat,
            texture::Wrap::Clamp => Wrap::Clamp,
            texture::Wrap::Mirror => Wrap::Mirror,
        };
        let encoded = record.encoding.value == Encoding::Srgb;
        self.picture(&record.file.value, &record.place, encoded, wrap, scale.map_or(1.0, |s| s.value), context)
    }

    /// A picture as a texture, made once for each way in which it is laid out.
    fn picture(
        &mut self,
        file: &Path,
        place: &Place,
        encoded: bool,
        wrap: Wrap,
        scale: f64,
        context: &mut Context<'_>,
    ) -> Option<TextureId> {
        let key = (file.to_owned(), encoded, wrap as u8, scale.to_bits());
        if let Some(id) = self.by_picture.get(&key) {
            return Some(*id);
        }
        let Some(image) = context.assets.images.get(file) else {
            context.fault(place, format!("the picture {} was not loaded", file.display()), "give a readable file");
            return None;
        };
        let sampling = Sampling { wrap: [wrap; 2], ..Sampling::default() };
        let texels = texels(image, encoded, scale as f32);
        let made = ImageTexture::new(image.width, image.height, texels, sampling);
        self.textures.push(context.accept(place, made)?);
        let id = TextureId((self.textures.len() - 1) as u32);
        self.by_picture.insert(key, id);
        Some(id)
    }

    fn slot_surface(&mut self, surface: &SlotSurface, place: &Place, context: &mut Context<'_>) -> Option<Surface> {
        let base = match surface.reflectance() {
            SlotReflectance::LinearSrgb(rgb) => {
                Reflectance::Spectrum(upsample::reflectance_spectrum(rgb.map(|v| v as f32)))
            }
            SlotReflectance::Image(file) => {
                Reflectance::Texture(self.picture(file, place, true, Wrap::Repeat, 1.0, context)?)
            }
        };
        match surface {
            SlotSurface::Diffuse { .. } => Some(Surface::Diffuse(base)),
            SlotSurface::Coated { index, alpha, .. } => {
                Some(Surface::Coated(Box::new(context.accept(place, Coated::new(base, *index, *alpha))?)))
            }
        }
    }
}

/// The texture of a name; a description that was read names only what it has.
fn named_texture<'s>(name: &str, scene: &'s Scene) -> Option<&'s record::Texture> {
    scene.textures.iter().find(|t| t.name.value == name)
}

fn conductor(r: &material::Conductor, context: &mut Context<'_>) -> Option<Conductor> {
    let Some(index) = metal::named(&r.metal.value) else {
        let problem = format!("there is no metal \"{}\"", r.metal.value);
        context.fault(&r.metal.place, problem, format!("give one of {}", metal::names().join(", ")));
        return None;
    };
    context.accept(&r.place, Conductor::new(index.clone(), r.alpha.value))
}

/// The picture's texels as the tracer keeps them; a factor other than 1 needs them as linear numbers. Opacity is left
/// out.
fn texels(image: &ImageAsset, encoded: bool, scale: f32) -> Texels {
    let bytes = |pixels: Vec<[u8; 3]>| match (encoded, scale == 1.0) {
        (true, true) => Texels::Srgb8(pixels),
        (false, true) => Texels::Linear8(pixels),
        (true, false) => floats(&pixels, |b| colour::decode_byte(b) * scale),
        (false, false) => floats(&pixels, |b| f32::from(b) / 255.0 * scale),
    };
    match &image.pixels {
        ImagePixels::Gray8(pixels) => bytes(pixels.iter().map(|g| [*g; 3]).collect()),
        ImagePixels::Gray16(pixels) => {
            let linear = |v: f32| if encoded { colour::decode(v) } else { v };
            Texels::Float(pixels.iter().map(|g| [linear(f32::from(*g) / 65_535.0) * scale; 3]).collect())
        }
        ImagePixels::Rgb8(pixels) => bytes(pixels.clone()),
        ImagePixels::Rgba8(pixels) => bytes(pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()),
        ImagePixels::Rgb32F(pixels) => {
            let linear = |v: f32| if encoded { colour::decode(v) } else { v };
            Texels::Float(pixels.iter().map(|p| p.map(|v| linear(v) * scale)).collect())
        }
        ImagePixels::Rgba32F(pixels) => {
            let linear = |v: f32| if encoded { colour::decode(v) } else { v };
            Texels::Float(pixels.iter().map(|[r, g, b, _]| [*r, *g, *b].map(|v| linear(v) * scale)).collect())
        }
    }
}

fn floats(pixels: &[[u8; 3]], linear: impl Fn(u8) -> f32) -> Texels {
    Texels::Float(pixels.iter().map(|p| p.map(&linear)).collect())
}
