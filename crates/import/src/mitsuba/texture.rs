//! Textures.

use etendue_io::exr::{ExrLayer, encode_layers};
use etendue_io::{Error, Provenance, picture::read_image};
use etendue_scene::record::material::factor::FactorTexture;
use etendue_scene::record::material::{Factor, Metal};
use etendue_scene::record::texture::{Encoding, Wrap};
use etendue_scene::record::{Colour, Reflectance, Texture};
use etendue_spectra::{Extrapolation, Spectrum, colour::luma};

use super::access::{flag, stated, text};
use super::transform::{TextureUsage, transform_of};
use super::{importer::Importer, value::MitsubaValue};
use crate::scenery::{KnownTexture, grey};
use crate::syntax::mitsuba::MitsubaElement;

const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];

/// Texture coordinates u, v of an image, v upwards as here: factors and offsets.
struct UvTransform {
    scale: [f64; 2],
    offset: [f64; 2],
}

impl<'a> Importer<'a> {
    /// Converts a texture.
    pub(super) fn texture(&mut self, element: &'a MitsubaElement, usage: TextureUsage) -> Result<KnownTexture, Error> {
        if let Some(known) = self.textures.get(&(element.number, usage)) {
            return Ok(known.clone());
        }
        self.at(element);
        let kind = element.kind();
        let converted = match kind {
            "bitmap" => self.bitmap(element, usage)?,
            "checkerboard" => self.checkerboard(element)?,
            _ => None,
        };
        let known = converted.unwrap_or_else(|| {
            self.scenery.report.note(format!("the texture \"{kind}\" is not supported: 0.5 is used instead"));
            element.children.iter().for_each(|child| child.used.set(true));
            KnownTexture::Even([0.5; 3])
        });
        self.note_unused(element);
        self.textures.insert((element.number, usage), known.clone());
        Ok(known)
    }

    /// `None` for a rotated or mirrored texture.
    fn uv_transform(&mut self, element: &'a MitsubaElement) -> Result<Option<UvTransform>, Error> {
        let to_uv = transform_of(element, "to_uv")?;
        let (m, t) = (to_uv.matrix3, to_uv.translation);
        // Of files before version 2.
        let own = |name: &str, default: f64| Ok::<f64, Error>(stated(element, name)?.unwrap_or(default));
        let [su, sv] = [m.x_axis.x * own("uscale", 1.0)?, m.y_axis.y * own("vscale", 1.0)?];
        // These files add the offset before scaling.
        let [tu, tv] = [t.x + su * own("uoffset", 0.0)?, t.y + sv * own("voffset", 0.0)?];
        if m.x_axis.y != 0.0 || m.y_axis.x != 0.0 || su <= 0.0 || sv <= 0.0 {
            return Ok(None);
        }
        // Mitsuba's v points downwards in images: 1 − v′ = s·(1 − v) + t.
        Ok(Some(UvTransform { scale: [su, sv], offset: [tu, 1.0 - sv - tv] }))
    }

    fn bitmap(&mut self, element: &'a MitsubaElement, usage: TextureUsage) -> Result<Option<KnownTexture>, Error> {
        let file = text(element, "filename")?.ok_or_else(|| element.error("the bitmap has no \"filename\""))?;
        let ending = file.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        if !ENDINGS.contains(&ending.as_str()) {
            let message = format!("the format of the image `{file}` is not supported; convert it to PNG or EXR");
            self.scenery.report.note(message);
            return Ok(None);
        }
        let is_raw = flag(element, "raw", false)?;
        let encoding = match (usage, is_raw || matches!(ending.as_str(), "hdr" | "exr")) {
            (TextureUsage::Data, _) => Encoding::Data,
            (_, true) => Encoding::Linear,
            (_, false) => Encoding::Srgb,
        };
        let wrap = match text(element, "wrap_mode")?.unwrap_or("repeat") {
            "repeat" => Wrap::Repeat,
            "clamp" => Wrap::Clamp,
            "mirror" => Wrap::Mirror,
            other => {
                return Err(
                    element.error(format!("unknown \"wrap_mode\" \"{other}\"; expected repeat, mirror or clamp"))
                );
            }
        };
        // All images are filtered by their footprint here.
        text(element, "filter_type")?;
        let Some(layout) = self.uv_transform(element)? else {
            self.scenery.report.note("rotation and mirroring of an image by \"to_uv\" are not supported");
            return Ok(None);
        };
        if (usage, encoding) == (TextureUsage::Numbers, Encoding::Srgb)
            && let Ok(image) = read_image(&self.file(file))
        {
            let path = self.scenery.numbers_file(&image, element.attribute("id").unwrap_or("texture"), luma);
            let path = path.map_err(|message| element.error(message))?;
            return Ok(Some(self.image_texture(element, &path, Encoding::Data, wrap, &layout)));
        }
        let path = self.path(file);
        Ok(Some(self.image_texture(element, &path, encoding, wrap, &layout)))
    }

    fn image_texture(
        &mut self,
        element: &MitsubaElement,
        path: &str,
        encoding: Encoding,
        wrap: Wrap,
        layout: &UvTransform,
    ) -> KnownTexture {
        let name = self.scenery.names.take(element.attribute("id").unwrap_or("texture"), "texture");
        let has_transform = (layout.scale, layout.offset) != ([1.0; 2], [0.0; 2]);
        self.scenery.scene.textures.push(Texture {
            wrap: Some(wrap.into()),
            uv_scale: has_transform.then(|| layout.scale.into()),
            uv_offset: has_transform.then(|| layout.offset.into()),
            ..Texture::new(name.as_str(), path, encoding)
        });
        KnownTexture::Picture { name, scale: 1.0, has_alpha: false }
    }

    /// Converts a checkerboard to an image of four squares.
    fn checkerboard(&mut self, element: &'a MitsubaElement) -> Result<Option<KnownTexture>, Error> {
        const SIDE: usize = 128;
        let mut colours = [[0.4; 3], [0.2; 3]];
        for (name, colour) in ["color0", "color1"].into_iter().zip(&mut colours) {
            *colour = match self.value(element, name)? {
                None => *colour,
                Some(MitsubaValue::Number(v) | MitsubaValue::Even(v)) => [v; 3],
                Some(MitsubaValue::Rgb(rgb)) => rgb,
                Some(_) => return Ok(None),
            };
        }
        let Some(layout) = self.uv_transform(element)? else { return Ok(None) };
        let channel = |i: usize| -> Vec<f32> {
            let colour_at =
                |at: usize| colours[usize::from((at % SIDE < SIDE / 2) != (at / SIDE < SIDE / 2))][i] as f32;
            (0..SIDE * SIDE).map(colour_at).collect()
        };
        let [r, g, b] = [0, 1, 2].map(channel);
        let layers = [("B", &b), ("G", &g), ("R", &r)].map(|(name, c)| (name.to_owned(), ExrLayer::Float(c)));
        let bytes =
            encode_layers(SIDE, SIDE, &layers, &Provenance::default()).map_err(|e| element.error(e.to_string()))?;
        let file = self.scenery.file_names.take("checkerboard", "checkerboard");
        let path = self.scenery.add_file(format!("textures/{file}.exr"), bytes);
        self.scenery.report.note("a checkerboard becomes an image of 128 by 128 pixels");
        Ok(Some(self.image_texture(element, &path, Encoding::Linear, Wrap::Repeat, &layout)))
    }

    /// Reflectance of a parameter, or `default`; `map` transforms its values.
    pub(super) fn reflectance(
        &mut self,
        element: &'a MitsubaElement,
        name: &str,
        default: f64,
        map: &dyn Fn(f64) -> f64,
    ) -> Result<Reflectance, Error> {
        let value = self.value(element, name)?.unwrap_or(MitsubaValue::Number(default));
        let texture = match value {
            MitsubaValue::Texture(texture) => self.texture(texture, TextureUsage::Colours)?,
            MitsubaValue::Number(v) | MitsubaValue::Even(v) => {
                let limited = self.scenery.limit_to_unit(name, v);
                return Ok(Reflectance::Plain(Colour::Grey(map(limited).into())));
            }
            MitsubaValue::Rgb(rgb) => KnownTexture::Even(rgb),
            MitsubaValue::Table(points) => {
                let plain = self.mapped_table(element, name, &points, map)?;
                return Ok(Reflectance::Plain(plain));
            }
            other => {
                let plain = self.reflectance_colour(name, &other);
                return Ok(Reflectance::Plain(plain.unwrap_or(Colour::Grey(default.into()))));
            }
        };
        Ok(match texture {
            KnownTexture::Even(rgb) => {
                let legal = rgb.map(|v| map(self.scenery.limit_to_unit(name, v)));
                Reflectance::Plain(self.scenery.reflectance_from_rgb(name, legal))
            }
            KnownTexture::Picture { name: texture, .. } => {
                if (map(0.5) - 0.5).abs() > 1e-9 {
                    self.scenery.report.note(format!(
                        "an image as the base of a plastic without \"nonlinear\" is darker here: by a factor of {:.2} where it is 0.5",
                        0.5 / map(0.5)
                    ));
                }
                Reflectance::Texture { name: texture.as_str().into(), scale: None }
            }
        })
    }

    /// Table of reflectances after `map`, every 5 nm if that makes straight lines curved.
    fn mapped_table(
        &mut self,
        element: &MitsubaElement,
        name: &str,
        points: &[(f64, f64)],
        map: &dyn Fn(f64) -> f64,
    ) -> Result<Colour, Error> {
        let legal: Vec<(f64, f64)> = points.iter().map(|(nm, v)| (*nm, self.scenery.limit_to_unit(name, *v))).collect();
        let is_straight = (map(0.5) - 0.5).abs() < 1e-9;
        let file = match is_straight {
            true => self.scenery.spectrum_file(&legal),
            false => {
                let spectrum = Spectrum::from_points(&legal, Extrapolation::Hold);
                let spectrum = spectrum.map_err(|e| element.error(format!("\"{name}\": {e}")))?;
                self.scenery.smooth_file(&Spectrum::from_fn(|nm| map(f64::from(spectrum.at(nm as f32)))), 1.0)
            }
        };
        Ok(Colour::Spectrum(file.as_str().into()))
    }

    /// Number of a parameter, 0 … 1, or `default`.
    pub(super) fn factor(&mut self, element: &'a MitsubaElement, name: &str, default: f64) -> Result<Factor, Error> {
        let even = match self.value(element, name)? {
            None => default,
            Some(MitsubaValue::Number(v) | MitsubaValue::Even(v)) => v,
            Some(MitsubaValue::Rgb(rgb)) => grey(rgb).unwrap_or_else(|| {
                self.scenery.report.note(format!("\"{name}\" from a colour is the mean of its components"));
                rgb.iter().sum::<f64>() / 3.0
            }),
            Some(MitsubaValue::Texture(texture)) => match self.texture(texture, TextureUsage::Numbers)? {
                KnownTexture::Even(rgb) => rgb[0],
                KnownTexture::Picture { name, .. } => return Ok(Factor::Texture(FactorTexture::new(name.as_str()))),
            },
            Some(_) => {
                self.scenery.report.note(format!("\"{name}\" from a spectrum is set to {default}"));
                default
            }
        };
        Ok(Factor::Number(self.scenery.limit_to_unit(name, even).into()))
    }

    /// Metal with a reflectance of three numbers at normal incidence, as in pbrt and glTF: n = 1.
    pub(super) fn metal_of_rgb(&mut self, rgb: [f64; 3]) -> Metal {
        let legal = rgb.map(|v| self.scenery.limit_to_unit("specular_reflectance", v));
        self.scenery.metal_from_rgb(legal)
    }
}
