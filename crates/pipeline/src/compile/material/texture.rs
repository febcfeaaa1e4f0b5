//! Textures that the scene defines, for what they are used.

use super::compiler::MaterialCompiler;
use super::texels::Reading;
use etendue_scene::Placed;
use etendue_scene::record::Texture;
use etendue_scene::record::texture::{self, Encoding, Mapping};
use etendue_tracer::textures::{Projection, Sampling, TextureId, Wrap};
use glam::Vec2;

/// How sharply pictures laid on from three sides meet, if it is not said.
const SHARPNESS: f32 = 4.0;

/// What a picture is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// Colours: reflectance, light.
    Colour,
    /// A number for each texel.
    Number,
    /// The picture's opacity as a number.
    Alpha,
    /// Normals.
    Normal,
}

impl MaterialCompiler<'_, '_> {
    /// The texture of a name for a use.
    pub(super) fn texture(&mut self, name: &Placed<String>, usage: Use, scale: f64) -> Option<TextureId> {
        let record = self.named_texture(&name.value)?.clone();
        self.check_encoding(&record, name, usage)?;
        self.needs_coordinates |= record.mapping() == Mapping::Uv || usage == Use::Normal;
        let encoded = record.encoding.value == Encoding::Srgb;
        let colour = record.encoding.value != Encoding::Data;
        let reading = Reading { encoded, alpha: usage == Use::Alpha, colour, scale: scale as f32 };
        self.pictures.picture(&record.file.value, &record.place, reading, sampling(&record), self.context)
    }

    /// Colours are no plain numbers, and plain numbers are not encoded.
    fn check_encoding(&mut self, record: &Texture, name: &Placed<String>, usage: Use) -> Option<()> {
        let (problem, remedy) = match (usage, record.encoding.value) {
            (Use::Colour, Encoding::Data) => ("plain numbers, and colours are needed here", "\"srgb\" or \"linear\""),
            (Use::Number, Encoding::Srgb) => ("sRGB-encoded colours, and plain numbers are needed here", "\"data\""),
            (Use::Normal, Encoding::Srgb | Encoding::Linear) => ("colours, and normals are needed here", "\"data\""),
            _ => return Some(()),
        };
        let problem = format!("the texture \"{}\" holds {problem} (it is defined at {})", name.value, record.place);
        self.context.fault(&name.place, problem, format!("say encoding = {remedy} if that is what the file holds"));
        None
    }
}

fn sampling(record: &Texture) -> Sampling {
    let wrap = match record.wrap.as_ref().map_or(texture::Wrap::Repeat, |w| w.value) {
        texture::Wrap::Repeat => Wrap::Repeat,
        texture::Wrap::Clamp => Wrap::Clamp,
        texture::Wrap::Mirror => Wrap::Mirror,
    };
    let pair = |given: &Option<Placed<[f64; 2]>>, default: Vec2| {
        given.as_ref().map_or(default, |p| Vec2::new(p.value[0] as f32, p.value[1] as f32))
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
