//! Textures.

use etendue_io::exr::{Layer, encode_layers};
use etendue_io::{Error, Provenance, picture::read_picture};
use etendue_scene::record::material::factor::FactorTexture;
use etendue_scene::record::material::{Factor, Metal};
use etendue_scene::record::texture::{Encoding, Wrap};
use etendue_scene::record::{Colour, Reflectance, Texture};
use etendue_spectra::{Outside, Spectrum, colour::luma};

use super::access::{flag, stated, text};
use super::transform::{Use, transform_of};
use super::{importer::Importer, value::Value};
use crate::scenery::{KnownTexture, grey};
use crate::syntax::mitsuba::MitsubaElement;

const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];

/// Texture coordinates u, v of an image, v upwards as here: factors and offsets.
struct Laid {
    scale: [f64; 2],
    offset: [f64; 2],
}

impl<'a> Importer<'a> {
    /// Converts a texture.
    pub(super) fn texture(&mut self, element: &'a MitsubaElement, usage: Use) -> Result<KnownTexture, Error> {
        if let Some(known) = self.textures.get(&(element.number, usage)) {
            return Ok(known.clone());
        }
        self.at(element);
        let kind = element.kind();
        let made = match kind {
            "bitmap" => self.bitmap(element, usage)?,
            "checkerboard" => self.checkerboard(element)?,
            _ => None,
        };
        let known = made.unwrap_or_else(|| {
            self.scenery.report.note(format!("the texture \"{kind}\" is not supported: 0.5 is used instead"));
            element.children.iter().for_each(|child| child.used.set(true));
            KnownTexture::Even([0.5; 3])
        });
        self.note_unused(element);
        self.textures.insert((element.number, usage), known.clone());
        Ok(known)
    }

    /// `None` for a rotated or mirrored texture.
    fn laid(&mut self, element: &'a MitsubaElement) -> Result<Option<Laid>, Error> {
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
        Ok(Some(Laid { scale: [su, sv], offset: [tu, 1.0 - sv - tv] }))
    }

    fn bitmap(&mut self, element: &'a MitsubaElement, usage: Use) -> Result<Option<KnownTexture>, Error> {
        let file = text(element, "filename")?.ok_or_else(|| element.fault("the bitmap has no \"filename\""))?;
        let ending = file.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        if !ENDINGS.contains(&ending.as_str()) {
            let message = format!("the format of the image `{file}` is not supported; convert it to PNG or EXR");
            self.scenery.report.note(message);
            return Ok(None);
        }
        let is_raw = flag(element, "raw", false)?;
        let encoding = match (usage, is_raw || matches!(ending.as_str(), "hdr" | "exr")) {
            (Use::Data, _) => Encoding::Data,
            (_, true) => Encoding::Linear,
            (_, false) => Encoding::Srgb,
        };
        let wrap = match text(element, "wrap_mode")?.unwrap_or("repeat") {
            "repeat" => Wrap::Repeat,
            "clamp" => Wrap::Clamp,
            "mirror" => Wrap::Mirror,
            other => {
                return Err(
                    element.fault(format!("unknown \"wrap_mode\" \"{other}\"; expected repeat, mirror or clamp"))
                );
            }
        };
        // All images are filtered by their footprint here.
        text(element, "filter_type")?;
        let Some(laid) = self.laid(element)? else {
            self.scenery.report.note("rotation and mirroring of an image by \"to_uv\" are not supported");
            return Ok(None);
        };
        if (usage, encoding) == (Use::Numbers, Encoding::Srgb)
            && let Ok(image) = read_picture(&self.file(file))
        {
            let path = self.scenery.numbers_file(&image, element.attribute("id").unwrap_or("texture"), luma);
            let path = path.map_err(|message| element.fault(message))?;
            return Ok(Some(self.picture(element, &path, Encoding::Data, wrap, &laid)));
        }
        let path = self.path(file);
        Ok(Some(self.picture(element, &path, encoding, wrap, &laid)))
    }

    fn picture(
        &mut self,
        element: &MitsubaElement,
        path: &str,
        encoding: Encoding,
        wrap: Wrap,
        laid: &Laid,
    ) -> KnownTexture {
        let name = self.scenery.names.take(element.attribute("id").unwrap_or("texture"), "texture");
        let is_laid = (laid.scale, laid.offset) != ([1.0; 2], [0.0; 2]);
        self.scenery.scene.textures.push(Texture {
            wrap: Some(wrap.into()),
            uv_scale: is_laid.then(|| laid.scale.into()),
            uv_offset: is_laid.then(|| laid.offset.into()),
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
                Some(Value::Number(v) | Value::Even(v)) => [v; 3],
                Some(Value::Rgb(rgb)) => rgb,
                Some(_) => return Ok(None),
            };
        }
        let Some(laid) = self.laid(element)? else { return Ok(None) };
        let channel = |i: usize| -> Vec<f32> {
            let of = |at: usize| colours[usize::from((at % SIDE < SIDE / 2) != (at / SIDE < SIDE / 2))][i] as f32;
            (0..SIDE * SIDE).map(of).collect()
        };
        let [r, g, b] = [0, 1, 2].map(channel);
        let layers = [("B", &b), ("G", &g), ("R", &r)].map(|(name, c)| (name.to_owned(), Layer::Float(c)));
        let bytes =
            encode_layers(SIDE, SIDE, &layers, &Provenance::default()).map_err(|e| element.fault(e.to_string()))?;
        let file = self.scenery.file_names.take("checkerboard", "checkerboard");
        let path = self.scenery.add_file(format!("textures/{file}.exr"), bytes);
        self.scenery.report.note("a checkerboard becomes an image of 128 by 128 pixels");
        Ok(Some(self.picture(element, &path, Encoding::Linear, Wrap::Repeat, &laid)))
    }

    /// Reflectance of a parameter, or `default`; `map` transforms its values.
    pub(super) fn reflectance(
        &mut self,
        element: &'a MitsubaElement,
        name: &str,
        default: f64,
        map: &dyn Fn(f64) -> f64,
    ) -> Result<Reflectance, Error> {
        let value = self.value(element, name)?.unwrap_or(Value::Number(default));
        let texture = match value {
            Value::Texture(texture) => self.texture(texture, Use::Colours)?,
            Value::Number(v) | Value::Even(v) => {
                let share = self.scenery.cut(name, v);
                return Ok(Reflectance::Plain(Colour::Grey(map(share).into())));
            }
            Value::Rgb(rgb) => KnownTexture::Even(rgb),
            Value::Table(points) => {
                let plain = self.mapped_table(element, name, &points, map)?;
                return Ok(Reflectance::Plain(plain));
            }
            other => {
                let plain = self.share(name, &other);
                return Ok(Reflectance::Plain(plain.unwrap_or(Colour::Grey(default.into()))));
            }
        };
        Ok(match texture {
            KnownTexture::Even(rgb) => {
                let legal = rgb.map(|v| map(self.scenery.cut(name, v)));
                Reflectance::Plain(self.scenery.share_of_rgb(name, legal))
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
        let legal: Vec<(f64, f64)> = points.iter().map(|(nm, v)| (*nm, self.scenery.cut(name, *v))).collect();
        let is_straight = (map(0.5) - 0.5).abs() < 1e-9;
        let file = match is_straight {
            true => self.scenery.spectrum_file(&legal),
            false => {
                let spectrum = Spectrum::from_points(&legal, Outside::Hold);
                let spectrum = spectrum.map_err(|e| element.fault(format!("\"{name}\": {e}")))?;
                self.scenery.smooth_file(&Spectrum::from_fn(|nm| map(f64::from(spectrum.at(nm as f32)))), 1.0)
            }
        };
        Ok(Colour::Spectrum(file.as_str().into()))
    }

    /// Number of a parameter, 0 … 1, or `default`.
    pub(super) fn factor(&mut self, element: &'a MitsubaElement, name: &str, default: f64) -> Result<Factor, Error> {
        let even = match self.value(element, name)? {
            None => default,
            Some(Value::Number(v) | Value::Even(v)) => v,
            Some(Value::Rgb(rgb)) => grey(rgb).unwrap_or_else(|| {
                self.scenery.report.note(format!("\"{name}\" from a colour is the mean of its components"));
                rgb.iter().sum::<f64>() / 3.0
            }),
            Some(Value::Texture(texture)) => match self.texture(texture, Use::Numbers)? {
                KnownTexture::Even(rgb) => rgb[0],
                KnownTexture::Picture { name, .. } => return Ok(Factor::Texture(FactorTexture::new(name.as_str()))),
            },
            Some(_) => {
                self.scenery.report.note(format!("\"{name}\" from a spectrum is set to {default}"));
                default
            }
        };
        Ok(Factor::Number(self.scenery.cut(name, even).into()))
    }

    /// Metal with a reflectance of three numbers at normal incidence, as in pbrt and glTF: n = 1.
    pub(super) fn metal_of_rgb(&mut self, rgb: [f64; 3]) -> Metal {
        let legal = rgb.map(|v| self.scenery.cut("specular_reflectance", v));
        self.scenery.metal_of_rgb(legal)
    }
}
