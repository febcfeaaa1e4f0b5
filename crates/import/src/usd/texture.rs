//! Images of UsdUVTexture.
//!
//! The outside of an image is defined by UsdUVTexture's wrapS and wrapT.
//!
//! Source: "UsdPreviewSurface Specification" 2.6: `useMetadata`, the default, means `black` for files without the metadata, such as PNG and JPEG files. Our
//! textures are never black outside: they continue with their edge.

use std::io::{BufReader, Cursor};
use std::{fs::File, path::Path, rc::Rc};

use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, encode_layers};
use etendue_io::picture::{decode_image, has_colours_of_8_bits, read_image};
use etendue_scene::record::texture::{Encoding, Wrap};
use etendue_scene::{asset::ImageAsset, record::Texture};
use etendue_spectra::colour;

use super::{importer::Importer, network::NodeInput};
use crate::scenery::{KnownTexture, stored_pixels};
use crate::syntax::usd::{UsdAsset, UsdFile, UsdPrim, UsdValue};

const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];
/// Maximum nodes between an image and its primvar.
const MAX_STEPS: usize = 8;

/// Source of a connected input.
pub(super) enum ImageInput<'a> {
    /// Constant.
    Even([f64; 3]),
    /// An image.
    Node(ImageNode<'a>),
}

/// Use of the colours of an image.
#[derive(Clone, Copy, Debug)]
pub(super) enum ColourRule {
    /// Reflectance, 0 … 1.
    Share,
    /// Light, 0 or more.
    Light,
}

impl ColourRule {
    fn apply(self, v: f64) -> f64 {
        match self {
            Self::Share => v.clamp(0.0, 1.0),
            Self::Light => v.max(0.0),
        }
    }
}

/// Image and its sampling.
pub(super) struct ImageNode<'a> {
    asset: &'a UsdAsset,
    pub(super) scale: [f64; 4],
    pub(super) bias: [f64; 4],
    /// Channel from 0 to 3; `None`: all colours.
    channel: Option<usize>,
    is_encoded: bool,
    wrap: Wrap,
    /// Transform of u, v: factors and offsets.
    uv_transform: [[f64; 2]; 2],
}

impl ImageNode<'_> {
    fn is_plain(&self) -> bool {
        self.bias == [0.0; 4] && self.channel.is_none()
    }

    /// Key that distinguishes our textures.
    fn key(&self) -> String {
        let Self { asset, scale, bias, channel, is_encoded, wrap, uv_transform } = self;
        let file = match &asset.file {
            Some(UsdFile::Plain(path)) => path.to_string_lossy().into_owned(),
            Some(UsdFile::Packed(name, _)) => format!("[{name}]"),
            None => String::new(),
        };
        format!("{file} {scale:?} {bias:?} {channel:?} {is_encoded} {wrap:?} {uv_transform:?}")
    }
}

impl<'a> Importer<'a> {
    /// Primvar of the texture coordinates of a surface's images, "st" if none is named; empty without images.
    pub(super) fn primvar_of(&mut self, shader: &'a UsdPrim) -> Rc<str> {
        let (mut primvars, mut has_pictures) = (Vec::<&'a str>::new(), false);
        for name in shader.attributes.keys().filter(|name| name.starts_with("inputs:")) {
            let Some(NodeInput::Shader(mut node, _)) = self.input(shader, name) else { continue };
            has_pictures = true;
            for _ in 0..MAX_STEPS {
                match self.plain_text(node, "info:id").unwrap_or_default() {
                    "UsdPrimvarReader_float2" => {
                        primvars
                            .extend(self.plain_text(node, "inputs:varname").filter(|name| !primvars.contains(name)));
                        break;
                    }
                    id => {
                        let next = if id == "UsdTransform2d" { "inputs:in" } else { "inputs:st" };
                        let Some(NodeInput::Shader(inner, _)) = self.input(node, next) else { break };
                        node = inner;
                    }
                }
            }
        }
        if primvars.len() > 1 {
            self.scenery
                .report
                .note(format!("of several texture coordinates of a surface only \"{}\" are used", primvars[0]));
        }
        let usual = if has_pictures { "st" } else { "" };
        primvars.first().copied().unwrap_or(usual).into()
    }

    /// Output of a node.
    pub(super) fn image_input(
        &mut self,
        node: &'a UsdPrim,
        output: &str,
        input_name: &str,
    ) -> Result<ImageInput<'a>, String> {
        let input_name = input_name.trim_start_matches("inputs:");
        let id = self.plain_text(node, "info:id").unwrap_or_default();
        if id != "UsdUVTexture" {
            self.scenery
                .report
                .note(format!("\"{input_name}\" of a node \"{id}\" is not supported: 0.5 is used instead"));
            return Ok(ImageInput::Even([0.5; 3]));
        }
        let channel = ["r", "g", "b", "a"].iter().position(|name| *name == output);
        let four = |name: &str, usual: f64| self.plain_tuple::<4>(node, name).unwrap_or([usual; 4]);
        let (scale, bias) = (four("inputs:scale", 1.0), four("inputs:bias", 0.0));
        let fallback = self.plain_tuple::<4>(node, "inputs:fallback").unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let asset = match self.input(node, "inputs:file") {
            Some(NodeInput::Value(UsdValue::Asset(asset))) if !asset.stated.is_empty() => Some(asset),
            _ => None,
        };
        let ending = asset.map(|asset| asset.stated.rsplit('.').next().unwrap_or_default().to_ascii_lowercase());
        let is_read = ending.as_deref().is_some_and(|ending| ENDINGS.contains(&ending));
        let Some(asset) = asset.filter(|asset| asset.file.is_some() && is_read) else {
            let shown = asset.map_or("", |asset| asset.stated.as_str());
            let why = if is_read { "does not exist" } else { "has an unsupported format; convert it to PNG or EXR" };
            self.scenery.report.note(format!("the image `{shown}` {why}: its fallback is used instead"));
            return Ok(ImageInput::Even(match channel {
                Some(channel) => [fallback[channel]; 3],
                None => [fallback[0], fallback[1], fallback[2]],
            }));
        };
        // For "auto" the file decides, whichever output is used; alpha is never encoded.
        let is_encoded = match self.plain_text(node, "inputs:sourceColorSpace").unwrap_or("auto") {
            "raw" => false,
            "sRGB" => true,
            _ => has_encoded_colours(asset),
        } && channel != Some(3);
        let ((wrap, is_black_outside), uv_transform) = (self.wrap(node), self.uv_transform(node));
        self.black_outside.extend(is_black_outside.then_some(uv_transform));
        self.note_unused(node);
        Ok(ImageInput::Node(ImageNode { asset, scale, bias, channel, is_encoded, wrap, uv_transform }))
    }

    /// Transform of u, v by a UsdTransform2d.
    fn uv_transform(&mut self, node: &'a UsdPrim) -> [[f64; 2]; 2] {
        let none = [[1.0; 2], [0.0; 2]];
        let Some(NodeInput::Shader(inner, _)) = self.input(node, "inputs:st") else { return none };
        if self.plain_text(inner, "info:id") != Some("UsdTransform2d") {
            return none;
        }
        let scale = self.plain_tuple::<2>(inner, "inputs:scale").unwrap_or([1.0; 2]);
        let offset = self.plain_tuple::<2>(inner, "inputs:translation").unwrap_or([0.0; 2]);
        let degrees = self.plain_number(inner, "inputs:rotation").unwrap_or(0.0);
        if degrees != 0.0 || scale.iter().any(|v| *v <= 0.0) {
            self.scenery.report.note("a UsdTransform2d that rotates or mirrors an image is not used");
            return none;
        }
        [scale, offset]
    }

    /// Colours: the image itself if it needs no change, else a new one of linear numbers.
    pub(super) fn colours(&mut self, node: &ImageNode<'a>, rule: ColourRule) -> Result<KnownTexture, String> {
        let factor = node.scale[0];
        let is_even = node.scale[..3] == [factor; 3] && factor > 0.0 && factor <= 1.0;
        let is_as_it_is = node.is_plain() && is_even;
        let rule_name = if is_as_it_is { "as it is".to_owned() } else { format!("{rule:?}") };
        let key = format!("colours {rule_name} {}", node.key());
        if let Some(known) = self.textures.get(&key) {
            return Ok(known.clone());
        }
        let known = if is_as_it_is {
            let path = self.file(node.asset)?;
            let encoding = if node.is_encoded { Encoding::Srgb } else { Encoding::Linear };
            let name = self.texture(node, &path, encoding);
            KnownTexture::Picture { name, scale: factor, has_alpha: false }
        } else {
            let image = self.image(node.asset)?;
            let pixels = values(&image, node, &|v| rule.apply(v));
            let name = self.baked(node, &image, &pixels, Encoding::Linear)?;
            KnownTexture::Picture { name, scale: 1.0, has_alpha: false }
        };
        self.textures.insert(key, known.clone());
        Ok(known)
    }

    /// Numbers after a rule, as the red of a new image.
    pub(super) fn numbers(&mut self, node: &ImageNode<'a>, rule: &dyn Fn(f64) -> f64) -> Result<KnownTexture, String> {
        // A rule is identified by its results for a few numbers.
        let probed: Vec<f64> = (0..=16).map(|i| rule(f64::from(i) / 16.0)).collect();
        let key = format!("numbers {probed:?} {}", node.key());
        if let Some(known) = self.textures.get(&key) {
            return Ok(known.clone());
        }
        let image = self.image(node.asset)?;
        let pixels = values(&image, node, &|v| rule(v.clamp(0.0, 1.0)).clamp(0.0, 1.0));
        let known = match pixels.iter().all(|pixel| pixel[0] == pixels[0][0]) {
            true => KnownTexture::Even(pixels[0].map(f64::from)),
            false => {
                let name = self.baked(node, &image, &pixels, Encoding::Data)?;
                KnownTexture::Picture { name, scale: 1.0, has_alpha: false }
            }
        };
        self.textures.insert(key, known.clone());
        Ok(known)
    }

    /// Mean colour of an image.
    pub(super) fn mean(&mut self, node: &ImageNode<'a>) -> Result<[f64; 3], String> {
        let image = self.image(node.asset)?;
        let pixels = values(&image, node, &|v| v.clamp(0.0, 1.0));
        let sum = pixels.iter().fold([0.0; 3], |sum, p| std::array::from_fn(|i| sum[i] + f64::from(p[i])));
        Ok(sum.map(|v| v / pixels.len() as f64))
    }

    /// Image of numbers that are not colours; returns the name of its texture.
    pub(super) fn data_image(&mut self, node: &ImageNode<'a>) -> Result<Option<String>, String> {
        let path = self.file(node.asset)?;
        Ok(Some(self.texture(node, &path, Encoding::Data)))
    }

    /// Path of an image as in the written scene; those of packages are written.
    pub(super) fn file(&mut self, asset: &UsdAsset) -> Result<String, String> {
        match &asset.file {
            Some(UsdFile::Plain(path)) => Ok(self.scenery.relative_path(path)),
            Some(UsdFile::Packed(name, bytes)) => {
                if let Some(known) = self.unpacked.get(name) {
                    return Ok(known.clone());
                }
                let path = Path::new(name);
                let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
                let own = self.scenery.file_names.take(&stem, "picture");
                let written = self.scenery.add_file(format!("textures/{own}.{ending}"), bytes.to_vec());
                self.scenery.check_size()?;
                self.unpacked.insert(name.clone(), written.clone());
                Ok(written)
            }
            None => Err(format!("the image `{}` does not exist", asset.stated)),
        }
    }

    /// Pixels of an image.
    pub(super) fn image(&self, asset: &UsdAsset) -> Result<ImageAsset, String> {
        let read = match &asset.file {
            Some(UsdFile::Plain(path)) => read_image(path),
            Some(UsdFile::Packed(name, bytes)) => decode_image(Path::new(name), bytes),
            None => return Err(format!("the image `{}` does not exist", asset.stated)),
        };
        read.map_err(|error| error.to_string())
    }

    fn texture(&mut self, node: &ImageNode<'a>, path: &str, encoding: Encoding) -> String {
        let stem = Path::new(&node.asset.stated).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = self.scenery.names.take(&stem, "texture");
        let [scale, offset] = node.uv_transform;
        let is_moved = node.uv_transform != [[1.0; 2], [0.0; 2]];
        self.scenery.scene.textures.push(Texture {
            wrap: Some(node.wrap.into()),
            uv_scale: is_moved.then(|| scale.into()),
            uv_offset: is_moved.then(|| offset.into()),
            ..Texture::new(name.as_str(), path, encoding)
        });
        name
    }

    /// Writes an image of linear numbers; returns the name of its texture.
    fn baked(
        &mut self,
        node: &ImageNode<'a>,
        image: &ImageAsset,
        pixels: &[[f32; 3]],
        encoding: Encoding,
    ) -> Result<String, String> {
        let channels = [2, 1, 0].map(|i| pixels.iter().map(|pixel| pixel[i]).collect::<Vec<f32>>());
        let layers: Vec<(String, ExrLayer<'_>)> =
            ["B", "G", "R"].iter().zip(&channels).map(|(name, c)| ((*name).to_owned(), ExrLayer::Float(c))).collect();
        let (width, height) = (image.width as usize, image.height as usize);
        let bytes = encode_layers(width, height, &layers, &Provenance::default()).map_err(|e| e.to_string())?;
        let stem = Path::new(&node.asset.stated).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let own = self.scenery.file_names.take(&stem, "picture");
        let path = self.scenery.add_file(format!("textures/{own}.exr"), bytes);
        self.scenery.check_size()?;
        Ok(self.texture(node, &path, encoding))
    }
}

/// Returns true if an image has sRGB-encoded colours, by UsdUVTexture's rule for `auto`: three or four channels of 8 bits.
fn has_encoded_colours(asset: &UsdAsset) -> bool {
    match &asset.file {
        // Reading a pipe would block; the reader refuses it.
        Some(UsdFile::Plain(path)) if path.is_file() => {
            File::open(path).is_ok_and(|opened| has_colours_of_8_bits(path, BufReader::new(opened)))
        }
        Some(UsdFile::Packed(name, bytes)) => has_colours_of_8_bits(Path::new(name), Cursor::new(bytes)),
        Some(UsdFile::Plain(_)) | None => false,
    }
}

/// Pixels of an image after its scale and bias, and a rule; a single channel gives all three.
fn values(image: &ImageAsset, node: &ImageNode<'_>, rule: &dyn Fn(f64) -> f64) -> Vec<[f32; 3]> {
    let decoded = |v: f32| if node.is_encoded { colour::decode(v) } else { v };
    let value = |p: [f32; 4]| {
        let linear = [decoded(p[0]), decoded(p[1]), decoded(p[2]), p[3]];
        let scaled: [f64; 4] = std::array::from_fn(|i| f64::from(linear[i]) * node.scale[i] + node.bias[i]);
        match node.channel {
            Some(channel) => [rule(scaled[channel]) as f32; 3],
            None => [scaled[0], scaled[1], scaled[2]].map(|v| rule(v) as f32),
        }
    };
    stored_pixels(image).into_iter().map(value).collect()
}

/// Continuation of an image outside.
#[derive(Clone, Copy, PartialEq, Eq)]
enum WrapMode {
    Black,
    Again(Wrap),
}

impl WrapMode {
    fn from_word(word: &str) -> Self {
        match word {
            "repeat" => Self::Again(Wrap::Repeat),
            "clamp" => Self::Again(Wrap::Clamp),
            "mirror" => Self::Again(Wrap::Mirror),
            _ => Self::Black,
        }
    }
}

impl<'a> Importer<'a> {
    /// Continuation of an image outside; the second value is true if it is black there.
    pub(super) fn wrap(&mut self, node: &'a UsdPrim) -> (Wrap, bool) {
        let [s, t] =
            ["inputs:wrapS", "inputs:wrapT"].map(|name| WrapMode::from_word(self.plain_text(node, name).unwrap_or("")));
        if s != t {
            self.scenery.report.note("wrapS and wrapT of an image differ: wrapS is used for both");
        }
        match s {
            WrapMode::Black => (Wrap::Clamp, true),
            WrapMode::Again(wrap) => (wrap, false),
        }
    }

    /// Notes that a shape shows the outside of an image that is black there.
    pub(super) fn note_outside(&mut self) {
        let message = "an image with wrap mode black (also if wrapS and wrapT are not stated or useMetadata) is clamped to its edge outside u, v = 0 … 1, \
            which the shape shows";
        self.scenery.report.note(message);
    }
}
