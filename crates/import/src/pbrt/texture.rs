//! Textures.

use etendue_io::picture::read_image;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_scene::record::material::factor::FactorTexture;
use etendue_scene::record::material::{Channel, Factor};
use etendue_scene::record::texture::{Encoding, Wrap};
use etendue_scene::record::{Colour, Reflectance, Texture};

use super::parameters::Parameters;
use crate::scenery::{KnownTexture, SceneBuilder, grey};
use crate::syntax::pbrt::{PbrtParameter, PbrtValues};

/// Returns true if an image has transparent parts: a fully opaque one has no opacity, as in pbrt.
fn has_opacity(image: &ImageAsset) -> bool {
    match &image.pixels {
        ImagePixels::Rgba8(pixels) => pixels.iter().any(|pixel| pixel[3] != u8::MAX),
        ImagePixels::Rgba32F(pixels) => pixels.iter().any(|pixel| pixel[3] != 1.0),
        _ => false,
    }
}

/// File of a texture as named in the written scene, and its encoding.
struct TextureFile {
    path: String,
    encoding: Encoding,
    has_alpha: bool,
}

const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];

impl SceneBuilder {
    pub(super) fn texture(
        &mut self,
        name: &str,
        values: &str,
        kind: &str,
        parameters: Parameters<'_>,
    ) -> Result<(), String> {
        let message = |what: String| format!("Texture \"{name}\": {what}");
        let is_colour = values != "float";
        let known = match kind {
            "imagemap" => self.image_texture(name, is_colour, parameters).map_err(message)?,
            "constant" => match parameters.find("value") {
                Some(value) => self.even(value).map_err(message)?,
                None => Some(KnownTexture::Even([1.0; 3])),
            },
            "scale" => self.scaled(is_colour, parameters).map_err(message)?,
            _ => None,
        };
        let known = known.unwrap_or_else(|| {
            self.report.note(format!("the texture \"{name}\" ({kind}) is not supported: 0.5 is used instead"));
            KnownTexture::Even([0.5; 3])
        });
        self.known.textures.insert((is_colour, name.to_owned()), known);
        self.note_unused(&format!("Texture \"{kind}\""), parameters.unused());
        Ok(())
    }

    fn even(&self, value: &PbrtParameter) -> Result<Option<KnownTexture>, String> {
        match (&*value.kind, &value.values) {
            ("texture", PbrtValues::Texts(_)) => Ok(None),
            (_, PbrtValues::Numbers(numbers)) if numbers.len() == 1 => Ok(Some(KnownTexture::Even([numbers[0]; 3]))),
            ("rgb", PbrtValues::Numbers(numbers)) => {
                super::colour::three(&value.name, numbers).map(KnownTexture::Even).map(Some)
            }
            _ => Ok(None),
        }
    }

    fn image_texture(
        &mut self,
        name: &str,
        is_colour: bool,
        parameters: Parameters<'_>,
    ) -> Result<Option<KnownTexture>, String> {
        let file = parameters.text("filename")?.ok_or("the imagemap has no \"filename\"")?;
        let ending = file.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        if !ENDINGS.contains(&ending.as_str()) {
            self.report.note(format!("the format of the image `{file}` is not supported; convert it to PNG or EXR"));
            return Ok(None);
        }
        let is_linear = matches!(ending.as_str(), "hdr" | "exr");
        // pbrt uses the stated encoding only for PNG files: JPEG is always sRGB.
        let encoding = match parameters.text("encoding")? {
            _ if is_linear => Encoding::Linear,
            None | Some("sRGB") => Encoding::Srgb,
            Some("linear") if ending == "png" => Encoding::Linear,
            Some(other) => {
                self.report.note(format!("the encoding \"{other}\" of an image is read as sRGB"));
                Encoding::Srgb
            }
        };
        let wrap = match parameters.text("wrap")? {
            None | Some("repeat") => Wrap::Repeat,
            Some("clamp") => Wrap::Clamp,
            Some(other) => {
                self.report.note(format!("wrap \"{other}\" of an image becomes clamp"));
                Wrap::Clamp
            }
        };
        if parameters.flag("invert", false)? {
            self.report.note("\"invert\" of an image is not supported: 0.5 is used instead");
            return Ok(None);
        }
        let pair = |a: &str, b: &str, default: f64| {
            Ok::<_, String>([parameters.number(a, default)?, parameters.number(b, default)?])
        };
        let (uv_scale, uv_offset) = (pair("uscale", "vscale", 1.0)?, pair("udelta", "vdelta", 0.0)?);
        if uv_scale.iter().any(|s| *s <= 0.0) || !matches!(parameters.text("mapping")?, None | Some("uv")) {
            self.report.note(format!("the mapping of the texture \"{name}\" is not supported: 0.5 is used instead"));
            return Ok(None);
        }
        let scale = parameters.number("scale", 1.0)?;
        let own = self.names.take(name, "texture");
        let TextureFile { path, encoding, has_alpha } = match is_colour {
            true => TextureFile { path: self.path_of(file), encoding, has_alpha: false },
            false => self.numbers_image(name, file, encoding)?,
        };
        self.scene.textures.push(Texture {
            wrap: Some(wrap.into()),
            uv_scale: Some(uv_scale.into()),
            uv_offset: Some(uv_offset.into()),
            ..Texture::new(own.as_str(), path.as_str(), encoding)
        });
        Ok(Some(KnownTexture::Picture { name: own, scale, has_alpha }))
    }

    /// Image of numbers: its opacity if it has one (leaves are cut out so), else the mean of its colours, rewritten if they are encoded. The plan reports an
    /// unreadable image.
    fn numbers_image(&mut self, name: &str, file: &str, encoding: Encoding) -> Result<TextureFile, String> {
        let image = read_image(&self.source_file(file)).ok();
        let has_alpha = image.as_ref().is_some_and(has_opacity);
        match image.filter(|_| encoding == Encoding::Srgb && !has_alpha) {
            Some(image) => {
                let path = self.numbers_file(&image, name, |rgb| rgb.iter().sum::<f32>() / 3.0)?;
                Ok(TextureFile { path, encoding: Encoding::Data, has_alpha })
            }
            None => Ok(TextureFile { path: self.path_of(file), encoding, has_alpha }),
        }
    }

    fn scaled(&self, is_colour: bool, parameters: Parameters<'_>) -> Result<Option<KnownTexture>, String> {
        let part = |name: &str, is_colour: bool| -> Result<Option<KnownTexture>, String> {
            match parameters.find(name) {
                None => Ok(Some(KnownTexture::Even([1.0; 3]))),
                Some(p) => match &p.values {
                    PbrtValues::Texts(texts) if p.kind == "texture" => {
                        let key = |is_colour| (is_colour, texts.first().cloned().unwrap_or_default());
                        let known = &self.known.textures;
                        Ok(known.get(&key(is_colour)).or_else(|| known.get(&key(!is_colour))).cloned())
                    }
                    _ => self.even(p),
                },
            }
        };
        Ok(match (part("tex", is_colour)?, part("scale", false)?) {
            (Some(KnownTexture::Even(a)), Some(KnownTexture::Even(b))) => {
                Some(KnownTexture::Even(std::array::from_fn(|i| a[i] * b[i])))
            }
            (Some(KnownTexture::Picture { name, scale, has_alpha }), Some(KnownTexture::Even(by)))
            | (Some(KnownTexture::Even(by)), Some(KnownTexture::Picture { name, scale, has_alpha })) => {
                grey(by).map(|by| KnownTexture::Picture { name, scale: scale * by, has_alpha })
            }
            _ => None,
        })
    }

    /// Converted texture of a parameter; `None` if it names none.
    pub(super) fn texture_of(
        &mut self,
        parameter: &PbrtParameter,
        is_colour: bool,
    ) -> Result<Option<KnownTexture>, String> {
        let PbrtValues::Texts(texts) = &parameter.values else { return Ok(None) };
        if parameter.kind != "texture" {
            return Ok(None);
        }
        let name = texts.first().cloned().unwrap_or_default();
        match self.known.textures.get(&(is_colour, name.clone())) {
            Some(known) => Ok(Some(known.clone())),
            None => Err(format!("\"{}\": the texture \"{name}\" is not defined before this", parameter.name)),
        }
    }

    /// Scale within our legal range for textures.
    fn legal_scale(&mut self, scale: f64) -> Option<f64> {
        if scale > 1.0 {
            self.report.note("a scale above 1 of an image is set to 1");
        }
        (scale < 1.0).then_some(scale.max(1e-6))
    }

    /// Reflectance of a parameter, or `default`.
    pub(super) fn reflectance(
        &mut self,
        parameters: Parameters<'_>,
        name: &str,
        default: f64,
    ) -> Result<Reflectance, String> {
        let Some(parameter) = parameters.find(name) else {
            return Ok(Reflectance::Plain(Colour::Grey(default.into())));
        };
        Ok(match self.texture_of(parameter, true)? {
            None => Reflectance::Plain(self.reflectance_colour(parameter)?),
            Some(KnownTexture::Even(rgb)) => Reflectance::Plain(self.reflectance_from_rgb(name, rgb)),
            Some(KnownTexture::Picture { name, scale, .. }) => {
                self.known.placed_images += 1;
                let scale = self.legal_scale(scale).map(Into::into);
                Reflectance::Texture { name: name.as_str().into(), scale }
            }
        })
    }

    /// Number of a parameter, 0 … 1 after `map`, or `default`; an image is used unchanged.
    pub(super) fn factor(
        &mut self,
        parameters: Parameters<'_>,
        name: &str,
        default: f64,
        map: fn(f64) -> f64,
    ) -> Result<Factor, String> {
        let even = match parameters.find(name) {
            None => default,
            Some(parameter) => match self.texture_of(parameter, false)? {
                None => parameters.number(name, default)?,
                Some(KnownTexture::Even(rgb)) => rgb[0],
                Some(KnownTexture::Picture { name: texture, scale, has_alpha }) => {
                    self.known.placed_images += 1;
                    if map(0.25) != 0.25 {
                        self.report.note(format!("an image of \"{name}\" is used as α directly, not as α²"));
                    }
                    let scale = self.legal_scale(scale).map(Into::into);
                    let channel = has_alpha.then(|| Channel::Alpha.into());
                    return Ok(Factor::Texture(FactorTexture {
                        scale,
                        channel,
                        ..FactorTexture::new(texture.as_str())
                    }));
                }
            },
        };
        let (mapped, legal) = (map(even), map(even).clamp(0.0, 1.0));
        if mapped != legal {
            self.report.note(format!("\"{name}\" of {even} gives {mapped}: {legal} is used instead"));
        }
        Ok(Factor::Number(legal.into()))
    }
}
