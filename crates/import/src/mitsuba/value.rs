//! Values over wavelength: numbers, colours, tables, and textures.

use etendue_io::{Error, read_regular};
use etendue_scene::limits;
use etendue_scene::record::{Colour, LightColour};
use etendue_spectra::{Extrapolation, Spectrum, colour::BT709, illuminant, observer};

use super::access::{find, number, number_of, numbers_of, text};
use super::importer::Importer;
use crate::scenery::{LightUnit, coefficient_from_rgb, illuminant_of};
use crate::syntax::mitsuba::MitsubaElement;

/// Value of a parameter.
pub(super) enum MitsubaValue<'a> {
    /// Number; white for a light.
    Number(f64),
    /// Linear sRGB.
    Rgb([f64; 3]),
    /// Constant over wavelength.
    Even(f64),
    /// Wavelengths in nm, increasing, and values.
    Table(Vec<(f64, f64)>),
    /// A black body's radiance at this temperature, K.
    BlackBody(f64),
    /// D65 of this luminance.
    D65(f64),
    /// An image.
    Texture(&'a MitsubaElement),
}

/// Pairs wavelengths with values.
fn paired(nm: Vec<f64>, values: Vec<f64>) -> Result<MitsubaValue<'static>, String> {
    let points: Vec<(f64, f64)> = nm.iter().copied().zip(values.iter().copied()).collect();
    match nm.len() == values.len() && nm.len() >= 2 && points.windows(2).all(|pair| pair[0].0 < pair[1].0) {
        true => Ok(MitsubaValue::Table(points)),
        false => {
            Err("expected two or more pairs of wavelength and value, in order of increasing wavelength".to_owned())
        }
    }
}

/// `0.5` or `400:0.1, 700:0.4`.
fn stated_spectrum(text: &str) -> Result<MitsubaValue<'static>, String> {
    if !text.contains(':') {
        return number_of(text).map(MitsubaValue::Even);
    }
    let words = text.split(|c: char| c == ',' || c.is_ascii_whitespace()).filter(|word| !word.is_empty());
    let pair = |word: &str| match word.split_once(':') {
        Some((nm, value)) => Ok((number_of(nm)?, number_of(value)?)),
        None => Err(format!("an entry of a spectrum has no wavelength: {word:.40}; expected WAVELENGTH:VALUE")),
    };
    let (nm, values) = words.map(pair).collect::<Result<Vec<_>, String>>()?.into_iter().unzip();
    paired(nm, values)
}

/// File with a wavelength and a value per line; `#` begins a comment.
fn spectrum_from_file(text: &str) -> Result<MitsubaValue<'static>, String> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default());
    let (mut nm, mut values) = (Vec::new(), Vec::new());
    for line in lines.filter(|line| !line.trim().is_empty()) {
        match numbers_of(line)?[..] {
            [wavelength, value] => {
                nm.push(wavelength);
                values.push(value);
            }
            _ => return Err("expected a wavelength and a value on each line".to_owned()),
        }
    }
    paired(nm, values)
}

/// Luminance of a radiance of 1 W·m⁻²·sr⁻¹·nm⁻¹ times a table, over that of the constant 1: the luminance that Mitsuba's images have.
fn relative_luminance(spectrum: &Spectrum) -> f64 {
    observer::luminance(spectrum) / observer::luminance(&Spectrum::constant(1.0))
}

impl<'a> Importer<'a> {
    /// Value of a parameter; `None` if it is absent.
    pub(super) fn value(&self, element: &'a MitsubaElement, name: &str) -> Result<Option<MitsubaValue<'a>>, Error> {
        find(element, name).map(|parameter| self.value_of(parameter)).transpose()
    }

    fn value_of(&self, parameter: &'a MitsubaElement) -> Result<MitsubaValue<'a>, Error> {
        let element = self.resolve(parameter)?;
        let located = |what: String| element.error(format!("\"{}\": {what}", parameter.name()));
        let value = element.attribute("value");
        match (element.tag, element.kind(), value) {
            ("float" | "integer", _, Some(value)) => number_of(value).map(MitsubaValue::Number).map_err(located),
            ("rgb", _, Some(value)) => match numbers_of(value).map_err(located)?[..] {
                [one] => Ok(MitsubaValue::Rgb([one; 3])),
                [r, g, b] => Ok(MitsubaValue::Rgb([r, g, b])),
                ref others => {
                    Err(located(format!("the number of values in an rgb is {}; expected three", others.len())))
                }
            },
            ("spectrum", "", Some(value)) => stated_spectrum(value).map_err(located),
            ("spectrum", "", None) => match element.attribute("filename") {
                Some(name) => self.spectrum_file(name).map_err(located),
                None => Err(located("the spectrum has neither \"value\" nor \"filename\"".to_owned())),
            },
            ("volume", "constvolume", _) => self.inner(element, "value"),
            ("spectrum" | "texture", kind, _) => self.plugin(element, kind),
            (tag, ..) => Err(located(format!("expected a number, a colour or a texture, found <{tag}>"))),
        }
    }

    fn spectrum_file(&self, name: &str) -> Result<MitsubaValue<'static>, String> {
        let bytes = read_regular(&self.file(name), &limits::DESCRIPTION).map_err(|e| format!("{name}: {e}"))?;
        let text = String::from_utf8(bytes).map_err(|_| format!("{name}: not a text file"))?;
        spectrum_from_file(&text).map_err(|problem| format!("{name}: {problem}"))
    }

    /// Value of a wrapper, which holds another value. A wrapper may contain neither another wrapper nor itself.
    fn inner(&self, element: &'a MitsubaElement, name: &str) -> Result<MitsubaValue<'a>, Error> {
        let wrong = |what: &str| element.error(format!("the {} \"{}\" {what} \"{name}\"", element.tag, element.kind()));
        let parameter = find(element, name).ok_or_else(|| wrong("has no"))?;
        match self.resolve(parameter)?.kind() {
            "srgb" | "constvolume" => Err(wrong("cannot have another wrapper as its")),
            _ => self.value_of(parameter),
        }
    }

    fn plugin(&self, element: &'a MitsubaElement, kind: &str) -> Result<MitsubaValue<'a>, Error> {
        let list = |name: &str| match text(element, name)? {
            Some(numbers) => numbers_of(numbers).map_err(|problem| element.error(problem)),
            None => Err(element.error(format!("the spectrum \"{kind}\" has no \"{name}\""))),
        };
        match kind {
            "uniform" => Ok(MitsubaValue::Even(number(element, "value", 1.0)?)),
            "d65" => Ok(MitsubaValue::D65(number(element, "scale", 1.0)?)),
            "blackbody" => {
                let kelvin = number(element, "temperature", 5000.0)?;
                match kelvin > 0.0 {
                    true => Ok(MitsubaValue::BlackBody(kelvin)),
                    false => Err(element.error(format!("the temperature of a black body is {kelvin} K; expected a number above 0"))),
                }
            }
            "srgb" => self.inner(element, "color"),
            "irregular" => paired(list("wavelengths")?, list("values")?).map_err(|problem| element.error(problem)),
            "regular" => {
                let values = list("values")?;
                let (low, high) =
                    (number(element, "wavelength_min", 360.0)?, number(element, "wavelength_max", 830.0)?);
                let step = (high - low) / (values.len().max(2) - 1) as f64;
                let nm = (0..values.len()).map(|i| low + i as f64 * step).collect();
                paired(nm, values).map_err(|problem| element.error(problem))
            }
            _ if element.tag == "texture" => Ok(MitsubaValue::Texture(element)),
            other => Err(element.error(format!(
                "the spectrum \"{other}\" is not supported; expected uniform, regular, irregular, blackbody, d65 or srgb"
            ))),
        }
    }

    /// Light of a parameter; white of luminance 1 if it is absent.
    pub(super) fn light(&mut self, element: &'a MitsubaElement, name: &str) -> Result<LightUnit, Error> {
        let white = |luminance: f64| LightUnit { colour: illuminant_of("D65"), luminance };
        let unit = match self.value(element, name)? {
            None => white(1.0),
            Some(MitsubaValue::Number(level) | MitsubaValue::D65(level)) => white(level),
            Some(MitsubaValue::Even(level)) => LightUnit { colour: illuminant_of("E"), luminance: level },
            Some(MitsubaValue::Rgb(rgb)) => {
                if rgb.iter().any(|v| *v < 0.0) {
                    return Err(element.error(format!("\"{name}\": emission is below 0")));
                }
                let luminance = rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
                LightUnit { colour: LightColour::Rgb(rgb.into()), luminance }
            }
            Some(MitsubaValue::BlackBody(kelvin)) => {
                let legal = kelvin.clamp(500.0, 20_000.0);
                if legal != kelvin {
                    self.scenery
                        .report
                        .note(format!("the temperature {kelvin} K of a black body is limited to {legal} K"));
                }
                let luminance = relative_luminance(&illuminant::blackbody(legal));
                LightUnit { colour: LightColour::Temperature(legal.into()), luminance }
            }
            Some(MitsubaValue::Table(points)) => {
                let spectrum = Spectrum::from_points(&points, Extrapolation::Zero);
                let spectrum = spectrum.map_err(|e| element.error(format!("\"{name}\": {e}")))?;
                let file = self.scenery.spectrum_file(&points);
                let colour = LightColour::Spectrum(file.as_str().into());
                LightUnit { colour, luminance: relative_luminance(&spectrum) }
            }
            Some(MitsubaValue::Texture(_)) => {
                self.scenery.report.note("the texture of a light is not used: its radiance is a uniform white of 1");
                white(1.0)
            }
        };
        match unit.luminance >= 0.0 && unit.luminance.is_finite() {
            true => Ok(unit),
            false => Err(element.error(format!("\"{name}\": emission is below 0"))),
        }
    }

    /// Reflectance, 0 … 1; `None` for a texture.
    pub(super) fn reflectance_colour(&mut self, name: &str, value: &MitsubaValue<'a>) -> Option<Colour> {
        let scenery = &mut self.scenery;
        Some(match value {
            MitsubaValue::Number(level) | MitsubaValue::Even(level) => {
                Colour::Grey(scenery.limit_to_unit(name, *level).into())
            }
            MitsubaValue::Rgb(rgb) => scenery.reflectance_from_rgb(name, *rgb),
            MitsubaValue::Table(points) => {
                let points: Vec<(f64, f64)> =
                    points.iter().map(|(nm, v)| (*nm, scenery.limit_to_unit(name, *v))).collect();
                Colour::Spectrum(scenery.spectrum_file(&points).as_str().into())
            }
            MitsubaValue::BlackBody(_) | MitsubaValue::D65(_) => {
                scenery.report.note(format!("\"{name}\" is an emission spectrum: grey of 0.5 is used instead"));
                Colour::Grey(0.5.into())
            }
            MitsubaValue::Texture(_) => return None,
        })
    }

    /// Quantity over wavelength, 0 or more, and its number if it is constant; `default` for a texture.
    pub(super) fn coefficient(
        &mut self,
        element: &'a MitsubaElement,
        name: &str,
        default: f64,
    ) -> Result<(Spectrum, Option<f64>), Error> {
        let located = |what: String| element.error(format!("\"{name}\": {what}"));
        let even = |v: f64| (Spectrum::constant(v), Some(v));
        let result = match self.value(element, name)? {
            None => even(default),
            Some(MitsubaValue::Number(v) | MitsubaValue::Even(v)) => even(v),
            Some(MitsubaValue::Rgb(rgb)) => coefficient_from_rgb(name, rgb).map_err(located)?,
            Some(MitsubaValue::Table(points)) => {
                (Spectrum::from_points(&points, Extrapolation::Hold).map_err(|e| located(e.to_string()))?, None)
            }
            Some(_) => {
                self.scenery
                    .report
                    .note(format!("\"{name}\" is not a number, colour or table and is set to {default}"));
                even(default)
            }
        };
        match (300..=1100).step_by(10).all(|nm| result.0.at(nm as f32) >= 0.0) {
            true => Ok(result),
            false => Err(located("below 0".to_owned())),
        }
    }
}

/// The reflectance of the base under a coat that reflects as much as Mitsuba's base of `a` without "nonlinear", whose inner reflections are those of a base of
/// 1 (`inner`: the fraction that the coat reflects inwards): a′/(1 − a′F) = a/(1 − F).
pub(super) fn linear_base(a: f64, inner: f64) -> f64 {
    a / (1.0 - inner + a * inner)
}

/// Fraction of diffuse light within a medium of index `n` that its boundary reflects: 1 − (1 − F)/n², with F for light from outside.
pub(super) fn inner_reflectance(n: f64) -> f64 {
    const STEPS: usize = 512;
    let outer = |i: usize| {
        let cos = (i as f64 + 0.5) / STEPS as f64;
        let inner_cos = (1.0 - (1.0 - cos * cos) / (n * n)).max(0.0);
        let inner_cos = inner_cos.sqrt();
        let (s, p) = ((cos - n * inner_cos) / (cos + n * inner_cos), (n * cos - inner_cos) / (n * cos + inner_cos));
        cos * (s * s + p * p)
    };
    let outer: f64 = (0..STEPS).map(outer).sum::<f64>() / STEPS as f64;
    1.0 - (1.0 - outer) / (n * n)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mitsuba's own number for a plastic of 1.49 in air, by a fit with an error of 5e-4.
    #[test]
    fn inner_reflectance_is_mitsubas() {
        assert!((inner_reflectance(1.49 / 1.000277) - 0.590479).abs() < 1e-3, "{}", inner_reflectance(1.49 / 1.000277));
    }

    #[test]
    fn spectra_are_read_in_all_their_forms() {
        let points = |text: &str| match stated_spectrum(text) {
            Ok(MitsubaValue::Table(points)) => points,
            Ok(MitsubaValue::Even(v)) => vec![(0.0, v)],
            _ => Vec::new(),
        };
        assert_eq!(points("0.5"), [(0.0, 0.5)]);
        assert_eq!(points("400:0.1, 700:0.4"), [(400.0, 0.1), (700.0, 0.4)]);
        assert!(stated_spectrum("700:1 400:2").is_err());
        assert!(
            matches!(spectrum_from_file("# nm, value\n400 1\n500, 2 # end\n"), Ok(MitsubaValue::Table(p)) if p.len() == 2)
        );
    }
}
