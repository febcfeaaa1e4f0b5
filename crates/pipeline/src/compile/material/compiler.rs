//! Compiler of materials: from records to the tracer's textures, numbers over a surface and normal maps.

use super::super::context::{Context, ErrorCode};
use super::picture::Pictures;
use super::texels::TexelInterpretation;
use etendue_scene::Placed;
use etendue_scene::record::material::{self, Factor};
use etendue_scene::record::texture::{self, Encoding, Mapping};
use etendue_scene::record::{self, Scene, Texture};
use etendue_tracer::textures::{Channel, Projection, Sampling, TextureId, Wrap};
use etendue_tracer::{MaterialId, materials};
use glam::Vec2;

/// Context of the compilation of materials.
pub(super) struct MaterialCompiler<'w, 'a> {
    pub(super) scene: &'w Scene,
    pub(super) pictures: &'w mut Pictures,
    pub(super) context: &'w mut Context<'a>,
    /// True if a texture with texture coordinates was used.
    pub(super) needs_coordinates: bool,
    /// For a material with a stated flux: number of emissive sides.
    pub(super) flux_sides: Option<f64>,
    /// For a modulated material: true if each of its objects has its own phase.
    pub(super) has_random_phases: bool,
}

impl MaterialCompiler<'_, '_> {
    /// Finds a texture by name; a loaded description names only existing ones.
    pub(super) fn named_texture(&self, name: &str) -> Option<&record::Texture> {
        self.scene.textures.iter().find(|t| t.name.value == name)
    }

    /// Id of a material of the scene, present or future: its position, because a plan contains no invalid material.
    pub(super) fn id_of(&self, name: &str) -> Option<MaterialId> {
        let place = self.scene.materials.iter().position(|m| m.name.value == name)?;
        Some(MaterialId(place as u32))
    }
}

/// Default sharpness of the transitions of images projected from three sides.
const SHARPNESS: f32 = 4.0;

/// Use of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ImageUse {
    /// Colours: reflectance, light.
    Colour,
    /// A number per texel.
    Number,
    /// Opacity of the image as a number.
    Alpha,
    Normal,
}

impl MaterialCompiler<'_, '_> {
    /// Texture of a name for a use.
    pub(super) fn texture(&mut self, name: &Placed<String>, usage: ImageUse, scale: f64) -> Option<TextureId> {
        let record = self.named_texture(&name.value)?.clone();
        self.check_encoding(&record, name, usage)?;
        self.needs_coordinates |= record.mapping() == Mapping::Uv || usage == ImageUse::Normal;
        let encoded = record.encoding.value == Encoding::Srgb;
        let colour = record.encoding.value != Encoding::Data;
        let reading = TexelInterpretation { encoded, alpha: usage == ImageUse::Alpha, colour, scale: scale as f32 };
        self.pictures.picture(&record.image_key(), &record.place, reading, sampling(&record), self.context)
    }

    /// Refuses colours as plain numbers, and encoded plain numbers.
    fn check_encoding(&mut self, record: &Texture, name: &Placed<String>, usage: ImageUse) -> Option<()> {
        let (problem, remedy) = match (usage, record.encoding.value) {
            (ImageUse::Colour, Encoding::Data) => {
                ("plain numbers, but colours are required here", "\"srgb\" or \"linear\"")
            }
            (ImageUse::Number, Encoding::Srgb) => {
                ("sRGB-encoded colours, but plain numbers are required here", "\"data\"")
            }
            (ImageUse::Normal, Encoding::Srgb | Encoding::Linear) => {
                ("colours, but normals are required here", "\"data\"")
            }
            _ => return Some(()),
        };
        let problem = format!("the texture \"{}\" contains {problem} (it is defined at {})", name.value, record.place);
        self.context.error(
            ErrorCode::UnsuitableFile,
            &name.place,
            problem,
            format!("set encoding = {remedy} if the file contains these"),
        );
        None
    }
}

fn sampling(record: &Texture) -> Sampling {
    let wrap = match record.wrap.as_ref().map_or(texture::Wrap::Repeat, |w| w.value) {
        texture::Wrap::Repeat => Wrap::Repeat,
        texture::Wrap::Clamp => Wrap::Clamp,
        texture::Wrap::Mirror => Wrap::Mirror,
    };
    let pair = |value: &Option<Placed<[f64; 2]>>, default: Vec2| {
        value.as_ref().map_or(default, |p| Vec2::new(p.value[0] as f32, p.value[1] as f32))
    };
    let (scale, offset) = (pair(&record.uv_scale, Vec2::ONE), pair(&record.uv_offset, Vec2::ZERO));
    let projection = match &record.size_m {
        None => Projection::Uv,
        Some(size_m) => Projection::Triplanar {
            size_m: size_m.value as f32,
            sharpness: record.sharpness.as_ref().map_or(SHARPNESS, |s| s.value as f32),
        },
    };
    Sampling { wrap: [wrap; 2], scale, offset, projection, ..Sampling::default() }
}

impl MaterialCompiler<'_, '_> {
    pub(super) fn factor(&mut self, factor: &Factor) -> Option<materials::Factor> {
        let texture = match factor {
            Factor::Number(number) => return Some(materials::Factor::Number(number.value as f32)),
            Factor::Texture(texture) => texture,
        };
        let (usage, channel) = match texture.channel.as_ref().map(|c| c.value) {
            Some(material::Channel::Red) => (ImageUse::Number, Channel::Red),
            Some(material::Channel::Green) => (ImageUse::Number, Channel::Green),
            Some(material::Channel::Blue) => (ImageUse::Number, Channel::Blue),
            // The opacity plane is a separate single-channel image.
            Some(material::Channel::Alpha) => (ImageUse::Alpha, Channel::Red),
            Some(material::Channel::Luminance) | None => (ImageUse::Number, Channel::Luminance),
        };
        let scale = texture.scale.as_ref().map_or(1.0, |s| s.value);
        Some(materials::Factor::Texture(self.texture(&texture.texture, usage, scale)?, channel))
    }

    pub(super) fn normal_map(&mut self, map: &material::NormalMap) -> Option<materials::NormalMap> {
        let texture = self.texture(&map.texture, ImageUse::Normal, 1.0)?;
        let green = match map.y.as_ref().map(|y| y.value) {
            Some(material::Green::Down) => materials::GreenDirection::Down,
            Some(material::Green::Up) | None => materials::GreenDirection::Up,
        };
        let strength = map.strength.as_ref().map_or(1.0, |s| s.value);
        self.context.accept(&map.place, materials::NormalMap::new(texture, green, strength))
    }
}
