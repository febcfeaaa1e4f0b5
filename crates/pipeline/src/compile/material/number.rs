//! Numbers over a surface, and normal maps.

use super::compiler::MaterialCompiler;
use super::texture::Use;
use etendue_scene::record::material::{self, Factor};
use etendue_tracer::materials;
use etendue_tracer::textures::Channel;

impl MaterialCompiler<'_, '_> {
    pub(super) fn factor(&mut self, factor: &Factor) -> Option<materials::Factor> {
        let texture = match factor {
            Factor::Number(number) => return Some(materials::Factor::Number(number.value as f32)),
            Factor::Texture(texture) => texture,
        };
        let (usage, channel) = match texture.channel.as_ref().map(|c| c.value) {
            Some(material::Channel::Red) => (Use::Number, Channel::Red),
            Some(material::Channel::Green) => (Use::Number, Channel::Green),
            Some(material::Channel::Blue) => (Use::Number, Channel::Blue),
            // The plane of opacity is a grey picture of its own.
            Some(material::Channel::Alpha) => (Use::Alpha, Channel::Red),
            Some(material::Channel::Luminance) | None => (Use::Number, Channel::Luminance),
        };
        let scale = texture.scale.as_ref().map_or(1.0, |s| s.value);
        Some(materials::Factor::Texture(self.texture(&texture.texture, usage, scale)?, channel))
    }

    pub(super) fn normal_map(&mut self, map: &material::NormalMap) -> Option<materials::NormalMap> {
        let texture = self.texture(&map.texture, Use::Normal, 1.0)?;
        let green = match map.y.as_ref().map(|y| y.value) {
            Some(material::Green::Down) => materials::Green::Down,
            Some(material::Green::Up) | None => materials::Green::Up,
        };
        let strength = map.strength.as_ref().map_or(1.0, |s| s.value);
        self.context.accept(&map.place, materials::NormalMap::new(texture, green, strength))
    }
}
