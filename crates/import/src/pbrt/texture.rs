//! Textures.
//!
//! A texture of pbrt is a tree. The material that uses it gets an image of the file, or an image of the tree's values that is written beside the scene.
//! Textures of positions become their mean.

use std::cell::RefCell;
use std::rc::Rc;

use etendue_scene::record::material::factor::FactorTexture;
use etendue_scene::record::material::{Channel, Factor};
use etendue_scene::record::{Colour, Reflectance};
use etendue_spectra::{Extrapolation, Spectrum, colour::linear_srgb_from_xyz, illuminant, observer};
use glam::DVec3;

use super::colour::points;
use super::parameters::Parameters;
use crate::scenery::{
    Graphics, ImageEncoding, ImageFile, ImageFormat, ImageLeaf, ImageUse, ImageWrap, KnownTexture, MARBLE_MEAN,
    Pattern, Placement, ProjectionKind, SceneBuilder, TextureBase, TextureProjection, TextureTree, TextureUse,
    mean_of_turbulence,
};
use crate::syntax::pbrt::{PbrtParameter, PbrtValues};

/// Texture directive in progress.
struct TextureReader<'a> {
    name: &'a str,
    is_colour: bool,
    parameters: Parameters<'a>,
    graphics: &'a Graphics,
}

impl SceneBuilder {
    pub(super) fn texture(
        &mut self,
        name: &str,
        values: &str,
        kind: &str,
        parameters: Parameters<'_>,
        graphics: &Graphics,
    ) -> Result<(), String> {
        let reader = TextureReader { name, is_colour: values != "float", parameters, graphics };
        let tree = self.tree(kind, &reader).map_err(|what| format!("Texture \"{name}\": {what}"))?;
        self.known.textures.insert((reader.is_colour, name.to_owned()), Rc::new(tree));
        self.note_unused(&format!("Texture \"{kind}\""), parameters.unused());
        Ok(())
    }

    fn tree(&mut self, kind: &str, reader: &TextureReader<'_>) -> Result<TextureTree, String> {
        let TextureReader { name, parameters, .. } = *reader;
        Ok(match kind {
            "imagemap" => TextureTree::Image(self.image_leaf(reader)?),
            "constant" => TextureTree::Constant(self.constant(parameters, "value", 1.0)?),
            "scale" => {
                let factor = TextureReader { is_colour: false, ..*reader };
                TextureTree::Product(self.part(reader, "tex", 1.0)?, self.part(&factor, "scale", 1.0)?)
            }
            "mix" => {
                let weight = TextureReader { is_colour: false, ..*reader };
                let amount = self.part(&weight, "amount", 0.5)?;
                TextureTree::Mix(self.part(reader, "tex1", 0.0)?, self.part(reader, "tex2", 1.0)?, amount)
            }
            "directionmix" => {
                parameters.find("dir");
                self.report.note(format!(
                    "the texture \"{name}\" (directionmix) depends on the normal: its mean is used instead"
                ));
                let half = Rc::new(TextureTree::Constant([0.5; 3]));
                TextureTree::Mix(self.part(reader, "tex1", 0.0)?, self.part(reader, "tex2", 1.0)?, half)
            }
            "checkerboard" => self.checkerboard(reader)?,
            "dots" => {
                let placement = self.placement_of(reader)?;
                let (inside, outside) = (self.part(reader, "inside", 1.0)?, self.part(reader, "outside", 0.0)?);
                TextureTree::Pattern(Pattern::Dots(inside, outside), placement)
            }
            "bilerp" => {
                let [v00, v10] = [self.constant(parameters, "v00", 0.0)?, self.constant(parameters, "v10", 0.0)?];
                let [v01, v11] = [self.constant(parameters, "v01", 1.0)?, self.constant(parameters, "v11", 1.0)?];
                TextureTree::Pattern(Pattern::Bilinear([v00, v10, v01, v11]), self.placement_of(reader)?)
            }
            "fbm" | "windy" | "wrinkled" | "marble" => self.mean_of_positions(kind, reader)?,
            _ => {
                self.report.note(format!("the texture \"{name}\" ({kind}) is not supported: 0.5 is used instead"));
                parameters.0.iter().for_each(|p| p.used.set(true));
                TextureTree::Constant([0.5; 3])
            }
        })
    }

    fn checkerboard(&mut self, reader: &TextureReader<'_>) -> Result<TextureTree, String> {
        let (first, second) = (self.part(reader, "tex1", 1.0)?, self.part(reader, "tex2", 0.0)?);
        match reader.parameters.number("dimension", 2.0)? {
            2.0 => Ok(TextureTree::Pattern(Pattern::Checkerboard(first, second), self.placement_of(reader)?)),
            3.0 => {
                self.note_mean_of_positions("checkerboard", reader.name);
                Ok(TextureTree::Mix(first, second, Rc::new(TextureTree::Constant([0.5; 3]))))
            }
            other => Err(format!("\"dimension\" is {other}; expected 2 or 3")),
        }
    }

    /// Mean of a pattern of positions; noise has the mean 0.
    fn mean_of_positions(&mut self, kind: &str, reader: &TextureReader<'_>) -> Result<TextureTree, String> {
        let octaves = reader.parameters.number("octaves", 8.0)?;
        let ratio = reader.parameters.number("roughness", 0.5)?;
        ["scale", "variation"].iter().for_each(|name| {
            reader.parameters.find(name);
        });
        self.note_mean_of_positions(kind, reader.name);
        Ok(TextureTree::Constant(match kind {
            "marble" => MARBLE_MEAN,
            "wrinkled" => [mean_of_turbulence(octaves, ratio); 3],
            _ => [0.0; 3],
        }))
    }

    fn note_mean_of_positions(&mut self, kind: &str, name: &str) {
        self.report.note(format!(
            "the texture \"{name}\" ({kind}) depends on the position in space: its mean is used instead"
        ));
    }

    /// Texture of a parameter, or its constant.
    fn part(&mut self, reader: &TextureReader<'_>, name: &str, default: f64) -> Result<Rc<TextureTree>, String> {
        if let Some(parameter) = reader.parameters.find(name)
            && let Some(tree) = self.texture_of(parameter, reader.is_colour)?
        {
            return Ok(tree);
        }
        Ok(Rc::new(TextureTree::Constant(self.constant(reader.parameters, name, default)?)))
    }

    /// Constant value of a parameter, in linear sRGB.
    fn constant(&mut self, parameters: Parameters<'_>, name: &str, default: f64) -> Result<[f64; 3], String> {
        let Some(parameter) = parameters.find(name) else { return Ok([default; 3]) };
        let pairs = match (&*parameter.kind, &parameter.values) {
            ("rgb" | "color", PbrtValues::Numbers(numbers)) => return super::colour::three(name, numbers),
            (_, PbrtValues::Numbers(numbers)) if numbers.len() == 1 => return Ok([numbers[0]; 3]),
            ("spectrum", PbrtValues::Numbers(numbers)) => points(name, numbers)?,
            ("spectrum", PbrtValues::Texts(texts)) => self.named_points(name, texts)?,
            (kind, _) => return Err(format!("\"{kind} {name}\": expected a number, an rgb, a spectrum or a texture")),
        };
        let spectrum = Spectrum::from_points(&pairs, Extrapolation::Zero).map_err(|e| format!("\"{name}\": {e}"))?;
        self.report.note("a spectrum in a texture is converted to sRGB");
        Ok(linear_srgb_from_xyz(observer::xyz_of_reflectance(&spectrum, illuminant::d65())))
    }

    fn placement_of(&mut self, reader: &TextureReader<'_>) -> Result<Placement, String> {
        let parameters = reader.parameters;
        let pair = |a: &str, b: &str, default: f64| {
            Ok::<_, String>([parameters.number(a, default)?, parameters.number(b, default)?])
        };
        let vector = |name: &str, default: DVec3| parameters.triple(name, default.to_array()).map(DVec3::from_array);
        let kind = match parameters.text("mapping")? {
            None | Some("uv") => {
                let (scale, offset) = (pair("uscale", "vscale", 1.0)?, pair("udelta", "vdelta", 0.0)?);
                return Ok(Placement { base: TextureBase::Surface, scale, offset });
            }
            Some("planar") => ProjectionKind::Planar { s: vector("v1", DVec3::X)?, t: vector("v2", DVec3::Y)? },
            Some("spherical") => ProjectionKind::Spherical,
            Some("cylindrical") => ProjectionKind::Cylindrical,
            Some(other) => {
                return Err(format!(
                    "the mapping \"{other}\" is unknown; expected uv, planar, spherical or cylindrical"
                ));
            }
        };
        let offset = match kind {
            ProjectionKind::Planar { .. } => pair("udelta", "vdelta", 0.0)?,
            _ => [0.0; 2],
        };
        let to_texture = reader.graphics.to_world.inverse();
        let base = TextureBase::Projection(TextureProjection { to_texture, kind });
        Ok(Placement { base, scale: [1.0; 2], offset })
    }

    fn image_leaf(&mut self, reader: &TextureReader<'_>) -> Result<ImageLeaf, String> {
        let parameters = reader.parameters;
        let file = parameters.text("filename")?.ok_or("the imagemap has no \"filename\"")?;
        let format = ImageFormat::from_name(file);
        if !format.is_known() {
            return Err(format!(
                "the format of the image `{file}` is not supported; expected PNG, JPEG, TGA, BMP, QOI, PNM, PFM, HDR or EXR: convert it and change the name"
            ));
        }
        // pbrt uses the stated encoding only for PNG files: other images of 8 bits are sRGB.
        let encoding = match parameters.text("encoding")? {
            _ if format.is_linear() => ImageEncoding::Linear,
            Some("linear") if format.is_png() => ImageEncoding::Linear,
            Some(stated) if format.is_png() && stated.starts_with("gamma") => {
                let exponent = stated.trim_start_matches("gamma").trim().parse::<f64>().ok().filter(|g| *g > 0.0);
                ImageEncoding::Gamma(exponent.ok_or_else(|| format!("the encoding \"{stated}\" has no exponent"))?)
            }
            None | Some("sRGB") => ImageEncoding::Srgb,
            Some(other) => {
                self.report.note(format!("the encoding \"{other}\" of an image is read as sRGB"));
                ImageEncoding::Srgb
            }
        };
        let wrap = match parameters.text("wrap")? {
            None | Some("repeat") => ImageWrap::Repeat,
            Some("clamp") => ImageWrap::Clamp,
            Some("black") => ImageWrap::Black,
            Some(other) => {
                self.report.note(format!("wrap \"{other}\" of an image becomes clamp"));
                ImageWrap::Clamp
            }
        };
        // Filters of pbrt differ in sharpness alone.
        ["filter", "maxanisotropy"].iter().for_each(|name| {
            parameters.find(name);
        });
        Ok(ImageLeaf {
            file: ImageFile { path: self.find_file(file), encoding },
            usage: if reader.is_colour { ImageUse::Colours } else { ImageUse::Numbers },
            wrap,
            scale: parameters.number("scale", 1.0)?,
            is_inverted: parameters.flag("invert", false)?,
            placement: self.placement_of(reader)?,
            pixels: RefCell::new(None),
        })
    }

    /// Texture of a parameter; `None` if it names none.
    pub(super) fn texture_of(
        &self,
        parameter: &PbrtParameter,
        is_colour: bool,
    ) -> Result<Option<Rc<TextureTree>>, String> {
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
}

/// Name of a texture in the file.
fn name_of(parameter: &PbrtParameter) -> &str {
    match &parameter.values {
        PbrtValues::Texts(texts) => texts.first().map_or("texture", String::as_str),
        _ => "texture",
    }
}

/// Scale of a texture, if it is not 1.
fn scale_below_1(scale: f64) -> Option<f64> {
    (scale < 1.0).then_some(scale.max(1e-6))
}

impl SceneBuilder {
    /// Reflectance of a parameter, or `default`.
    pub(super) fn reflectance(
        &mut self,
        parameters: Parameters<'_>,
        name: &str,
        default: f64,
    ) -> Result<Reflectance, String> {
        self.scaled_reflectance(parameters, name, default, 1.0)
    }

    /// The same times a factor.
    pub(super) fn scaled_reflectance(
        &mut self,
        parameters: Parameters<'_>,
        name: &str,
        default: f64,
        factor: f64,
    ) -> Result<Reflectance, String> {
        let Some(parameter) = parameters.find(name) else {
            let value = self.limit_to_unit(name, factor * default);
            return Ok(Reflectance::Plain(Colour::Grey(value.into())));
        };
        let Some(tree) = self.texture_of(parameter, true)? else {
            let scaled = self.scaled(parameter, factor)?;
            return Ok(Reflectance::Plain(self.reflectance_colour(&scaled)?));
        };
        let tree = match factor {
            1.0 => tree,
            _ => Rc::new(TextureTree::Product(tree, Rc::new(TextureTree::Constant([factor; 3])))),
        };
        let placed = self.placed_texture(name_of(parameter), &tree, TextureUse::Colours)?;
        Ok(match placed.texture {
            KnownTexture::Even(rgb) => Reflectance::Plain(self.reflectance_from_rgb(name, rgb)),
            KnownTexture::Picture { name, scale, .. } => {
                self.known.placed_images.push(placed.base);
                Reflectance::Texture { name: name.as_str().into(), scale: scale_below_1(scale).map(Into::into) }
            }
        })
    }

    /// Colour times a factor.
    fn scaled(&mut self, parameter: &PbrtParameter, factor: f64) -> Result<PbrtParameter, String> {
        let mut scaled = parameter.clone();
        if factor == 1.0 {
            return Ok(scaled);
        }
        if let PbrtValues::Texts(texts) = &parameter.values {
            let pairs = self.named_points(&parameter.name, texts)?;
            scaled.values = PbrtValues::Numbers(pairs.into_iter().flat_map(|(nm, value)| [nm, value]).collect());
        }
        let is_table = scaled.kind == "spectrum";
        if let PbrtValues::Numbers(numbers) = &mut scaled.values {
            let values = numbers.iter_mut().enumerate().filter(|(i, _)| !is_table || i % 2 == 1);
            values.for_each(|(_, value)| *value *= factor);
        }
        Ok(scaled)
    }

    /// Number of a parameter, 0 … 1 in its use, or `default`.
    pub(super) fn factor(
        &mut self,
        parameters: Parameters<'_>,
        name: &str,
        default: f64,
        usage: TextureUse,
    ) -> Result<Factor, String> {
        let tree = match parameters.find(name) {
            None => None,
            Some(parameter) => self.texture_of(parameter, false)?.map(|tree| (name_of(parameter), tree)),
        };
        let placed = match tree {
            None => None,
            Some((texture, tree)) => Some(self.placed_texture(texture, &tree, usage)?),
        };
        let even = match placed {
            None => parameters.number(name, default)?,
            Some(placed) => match placed.texture {
                KnownTexture::Even(rgb) => rgb[0],
                KnownTexture::Picture { name: texture, scale, has_alpha } => {
                    self.known.placed_images.push(placed.base);
                    return Ok(Factor::Texture(FactorTexture {
                        scale: scale_below_1(scale).map(Into::into),
                        channel: has_alpha.then(|| Channel::Alpha.into()),
                        ..FactorTexture::new(texture.as_str())
                    }));
                }
            },
        };
        let (mapped, legal) = (usage.mapped(even), usage.mapped(even).clamp(0.0, 1.0));
        if mapped != legal {
            self.report.note(format!("\"{name}\" of {even} gives {mapped}: {legal} is used instead"));
        }
        Ok(Factor::Number(legal.into()))
    }
}
