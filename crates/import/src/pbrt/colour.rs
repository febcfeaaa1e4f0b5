//! Spectra: rgb, tables, black bodies and names.

use etendue_scene::record::{Colour, LightColour};
use etendue_spectra::{Extrapolation, Spectrum, colour::BT709, illuminant};

use super::parameters::Parameters;
use crate::scenery::{LightUnit, SceneBuilder, coefficient_from_rgb, illuminant_of};
use crate::syntax::pbrt::{PbrtParameter, PbrtValues};

pub(super) fn three(name: &str, numbers: &[f64]) -> Result<[f64; 3], String> {
    let count = numbers.len();
    numbers.try_into().map_err(|_| format!("\"{name}\": the number of values in an rgb is {count}; expected three"))
}

/// Our name of an illuminant of pbrt, whether we have its table or not.
pub(super) fn illuminant_name(name: &str) -> Option<String> {
    match name {
        "illum-acesD60" => Some("D60".to_owned()),
        _ => name.strip_prefix("stdillum-").map(|name| name.replace('F', "FL")),
    }
}

/// Distance beyond its ends at which a spectrum is 0, nm.
const END_NM: f64 = 1e-3;

/// Alternating wavelengths in nm and values.
pub(super) fn points(name: &str, numbers: &[f64]) -> Result<Vec<(f64, f64)>, String> {
    let pairs: Vec<(f64, f64)> = numbers.as_chunks::<2>().0.iter().map(|[nm, value]| (*nm, *value)).collect();
    let rising = pairs.windows(2).all(|pair| pair[0].0 < pair[1].0);
    match numbers.len().is_multiple_of(2) && !pairs.is_empty() && rising {
        true => Ok(pairs),
        false => Err(format!("\"{name}\": expected pairs of wavelength and value, in order of increasing wavelength")),
    }
}

/// The same for a light or a reflectance, which pbrt takes as 0 outside the given wavelengths.
fn ended(pairs: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let ends = [pairs[0].0 - END_NM, pairs[pairs.len() - 1].0 + END_NM].map(|nm| (nm, 0.0));
    ends[..1].iter().chain(pairs).chain(&ends[1..]).copied().collect()
}

/// A spectrum of pairs of wavelength and value.
pub(super) fn table(name: &str, numbers: &[f64], outside: Extrapolation) -> Result<Spectrum, String> {
    Spectrum::from_points(&points(name, numbers)?, outside).map_err(|e| format!("\"{name}\": {e}"))
}

impl SceneBuilder {
    /// Light of the parameter `name`; white of luminance 1 if it is absent.
    pub(super) fn light(&mut self, parameters: Parameters<'_>, name: &str) -> Result<LightUnit, String> {
        let Some(parameter) = parameters.find(name) else {
            return Ok(LightUnit { colour: illuminant_of("D65"), luminance: 1.0 });
        };
        match (&*parameter.kind, &parameter.values) {
            ("rgb" | "color", PbrtValues::Numbers(numbers)) => {
                let rgb = three(name, numbers)?;
                if rgb.iter().any(|v| *v < 0.0) {
                    return Err(format!("\"{name}\": emission is below 0"));
                }
                let luminance = rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
                Ok(LightUnit { colour: LightColour::Rgb(rgb.into()), luminance })
            }
            ("blackbody", PbrtValues::Numbers(numbers)) => {
                let kelvin = *numbers.first().ok_or("the black body has no temperature")?;
                let legal = kelvin.clamp(500.0, 20_000.0);
                if legal != kelvin {
                    self.report.note(format!("the temperature {kelvin} K of a black body is limited to {legal} K"));
                }
                Ok(LightUnit { colour: LightColour::Temperature(legal.into()), luminance: 1.0 })
            }
            ("spectrum", PbrtValues::Numbers(numbers)) => {
                let pairs = points(name, numbers)?;
                Ok(self.tabulated_light(&pairs))
            }
            ("spectrum", PbrtValues::Texts(texts)) => self.named_light(name, texts),
            (kind, _) => Err(format!("\"{kind} {name}\" is not an emission; expected rgb, blackbody or spectrum")),
        }
    }

    fn tabulated_light(&mut self, pairs: &[(f64, f64)]) -> LightUnit {
        let file = self.spectrum_file(&ended(pairs));
        LightUnit { colour: LightColour::Spectrum(file.as_str().into()), luminance: 1.0 }
    }

    fn named_light(&mut self, parameter: &str, texts: &[String]) -> Result<LightUnit, String> {
        let name = texts.first().map_or("", String::as_str);
        let Some(own) = illuminant_name(name) else {
            let pairs = self.named_points(parameter, texts)?;
            return Ok(self.tabulated_light(&pairs));
        };
        let is_known = illuminant::names().contains(&own.as_str());
        if !is_known {
            self.report.note(format!("the emission spectrum \"{name}\" has no table here: D65 is used instead"));
        }
        Ok(LightUnit { colour: illuminant_of(if is_known { &own } else { "D65" }), luminance: 1.0 })
    }

    /// Reflectance, 0 … 1.
    pub(super) fn reflectance_colour(&mut self, parameter: &PbrtParameter) -> Result<Colour, String> {
        let name = &parameter.name;
        match (&*parameter.kind, &parameter.values) {
            ("rgb" | "color", PbrtValues::Numbers(numbers)) => {
                Ok(self.reflectance_from_rgb(name, three(name, numbers)?))
            }
            ("float", PbrtValues::Numbers(numbers)) if numbers.len() == 1 => {
                Ok(Colour::Grey(self.limit_to_unit(name, numbers[0]).into()))
            }
            ("spectrum", PbrtValues::Numbers(numbers)) => {
                let pairs = points(name, numbers)?;
                Ok(self.tabulated_reflectance(name, &pairs))
            }
            ("spectrum", PbrtValues::Texts(texts)) => {
                let pairs = self.named_points(name, texts)?;
                Ok(self.tabulated_reflectance(name, &pairs))
            }
            (kind, _) => {
                Err(format!("\"{kind} {name}\" is not a reflectance or transmittance; expected rgb or spectrum"))
            }
        }
    }

    fn tabulated_reflectance(&mut self, name: &str, pairs: &[(f64, f64)]) -> Colour {
        let legal: Vec<(f64, f64)> =
            ended(pairs).into_iter().map(|(nm, v)| (nm, self.limit_to_unit(name, v))).collect();
        let file = self.spectrum_file(&legal);
        Colour::Spectrum(file.as_str().into())
    }

    /// Coefficient over wavelength, 0 or more, at the wavelengths of [`smooth_file`](Self::smooth_file); the second value is the number if it is constant.
    pub(super) fn coefficient(
        &mut self,
        parameters: Parameters<'_>,
        name: &str,
        default: [f64; 3],
    ) -> Result<(Spectrum, Option<f64>), String> {
        let rgb = match parameters.find(name).map(|p| (&*p.kind, &p.values)) {
            None => default,
            Some(("rgb" | "color", PbrtValues::Numbers(numbers))) => three(name, numbers)?,
            Some(("spectrum", PbrtValues::Numbers(numbers))) => {
                return Ok((table(name, numbers, Extrapolation::Zero)?, None));
            }
            Some(("spectrum", PbrtValues::Texts(texts))) => {
                let pairs = self.named_points(name, texts)?;
                let spectrum = Spectrum::from_points(&pairs, Extrapolation::Zero);
                return Ok((spectrum.map_err(|e| format!("\"{name}\": {e}"))?, None));
            }
            Some((kind, _)) => {
                return Err(format!("\"{kind} {name}\": expected an rgb or a table of wavelengths and values"));
            }
        };
        coefficient_from_rgb(name, rgb)
    }
}
