//! Spectra by pbrt's names and in files, and refractive indices of every form.

use etendue_io::source::{decode_text, read_bytes};
use etendue_spectra::glass::{self, CatalogueGlass};
use etendue_spectra::{Extrapolation, Spectrum, illuminant, metal};

use super::colour::{illuminant_name, points, table, three};
use crate::scenery::{SceneBuilder, coefficient_from_rgb};
use crate::syntax::pbrt::{PbrtParameter, PbrtValues};

/// Wavelength of the index of dielectrics, nm.
const LINE_D_NM: f32 = 587.56;

/// Glasses of pbrt by the ends of their names, and in the makers' catalogues. In pbrt-v4 `glass-F5`, `glass-F10` and `glass-F11` are SF5, SF10 and SF11.
const GLASSES: [(&str, &str); 10] = [
    ("BK7", "N-BK7"),
    ("BAF10", "N-BAF10"),
    ("FK51A", "N-FK51A"),
    ("LASF9", "N-LASF9"),
    ("SF5", "SF5"),
    ("SF10", "SF10"),
    ("SF11", "SF11"),
    ("F5", "SF5"),
    ("F10", "SF10"),
    ("F11", "SF11"),
];

/// Catalogue glass of a name of pbrt.
pub(super) fn known_glass(name: &str) -> Option<&'static CatalogueGlass> {
    let end = name.strip_prefix("glass-").unwrap_or(name);
    let (_, catalogue_name) = GLASSES.iter().find(|(known, _)| *known == end)?;
    glass::by_name(catalogue_name).ok()
}

/// Spectrum by a name of pbrt; `None` for other names.
fn known_spectrum(name: &str) -> Option<Spectrum> {
    if let Some(metal) = name.strip_prefix("metal-") {
        let (symbol, part) = metal.rsplit_once('-')?;
        let index = metal::by_name(symbol)?;
        return match part {
            "eta" => Some(index.n.clone()),
            "k" => Some(index.k.clone()),
            _ => None,
        };
    }
    if name.starts_with("glass-") {
        return known_glass(name).map(|glass| Spectrum::from_fn(|nm| glass.dispersion.index(nm)));
    }
    illuminant::by_name(&illuminant_name(name)?).cloned()
}

/// Symbol of the metal whose complex index the names of both parts give.
pub(super) fn metal_of_names<'a>(eta: &'a str, k: &str) -> Option<&'a str> {
    let symbol = eta.strip_prefix("metal-")?.strip_suffix("-eta")?;
    let is_same = k.strip_prefix("metal-")?.strip_suffix("-k")? == symbol;
    (is_same && metal::names().contains(&symbol)).then_some(symbol)
}

/// Refractive index, or its imaginary part, over wavelength.
pub(super) struct IndexSpectrum {
    pub(super) spectrum: Spectrum,
    /// Value of one that is the same everywhere.
    pub(super) constant: Option<f64>,
}

impl IndexSpectrum {
    pub(super) fn at_d_line(&self) -> f64 {
        // Spectra are stored as f32.
        self.constant.unwrap_or_else(|| (1e5 * f64::from(self.spectrum.at(LINE_D_NM))).round() / 1e5)
    }
}

impl SceneBuilder {
    /// Wavelengths in nm and values of a spectrum by name: pbrt's, or a file.
    pub(super) fn named_points(&mut self, parameter: &str, texts: &[String]) -> Result<Vec<(f64, f64)>, String> {
        let name = texts.first().map_or("", String::as_str);
        if let Some(known) = known_spectrum(name) {
            return Ok((60..=220).map(|i| 5 * i).map(|nm| (f64::from(nm), f64::from(known.at(nm as f32)))).collect());
        }
        let file = self.find_file(name);
        if !file.is_file() {
            return Err(format!(
                "\"{parameter}\": the spectrum \"{name}\" is neither a name of pbrt-v4 that is supported here nor a file; give a file of wavelengths in nm \
                    and values"
            ));
        }
        let bytes = read_bytes(&file, "spectrum").map_err(|e| e.to_string())?;
        let text = decode_text(&file, &bytes).map_err(|e| e.to_string())?;
        points(parameter, &spectrum_numbers(text).map_err(|e| format!("{}:{e}", file.display()))?)
            .map_err(|e| format!("{}: {e}", file.display()))
    }

    /// Index of any form: number, rgb, table, name or file. An rgb is pbrt's unbounded spectrum; end values are held, where pbrt's are 0.
    pub(super) fn index_spectrum(&mut self, parameter: &PbrtParameter) -> Result<IndexSpectrum, String> {
        let name = &parameter.name;
        let constant = |value: f64| IndexSpectrum { spectrum: Spectrum::constant(value), constant: Some(value) };
        match (&*parameter.kind, &parameter.values) {
            ("rgb" | "color", PbrtValues::Numbers(numbers)) => {
                let (spectrum, even) = coefficient_from_rgb(name, three(name, numbers)?)?;
                Ok(IndexSpectrum { spectrum, constant: even })
            }
            (_, PbrtValues::Numbers(numbers)) if numbers.len() == 1 => Ok(constant(numbers[0])),
            ("spectrum", PbrtValues::Numbers(numbers)) => {
                Ok(IndexSpectrum { spectrum: table(name, numbers, Extrapolation::Hold)?, constant: None })
            }
            ("spectrum", PbrtValues::Texts(texts)) => {
                let points = self.named_points(name, texts)?;
                let spectrum =
                    Spectrum::from_points(&points, Extrapolation::Hold).map_err(|e| format!("\"{name}\": {e}"))?;
                Ok(IndexSpectrum { spectrum, constant: None })
            }
            (kind, _) => {
                Err(format!("\"{kind} {name}\" is not a refractive index; expected a float, an rgb or a spectrum"))
            }
        }
    }
}

/// Numbers of a text, separated by blanks or commas; `#` begins a comment.
pub(super) fn spectrum_numbers(text: &str) -> Result<Vec<f64>, String> {
    let mut numbers = Vec::new();
    for (line, content) in text.lines().enumerate() {
        let content = content.split('#').next().unwrap_or_default();
        for word in content.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty()) {
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => numbers.push(number),
                _ => return Err(format!("{}: expected a finite number, found `{word}`", line + 1)),
            }
        }
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// n_d of Schott's data sheets, to their five digits.
    #[test]
    fn glasses_have_their_index() {
        for (name, n_d) in [
            ("glass-BK7", 1.5168),
            ("glass-BAF10", 1.67003),
            ("glass-FK51A", 1.48656),
            ("glass-LASF9", 1.85025),
            ("glass-SF5", 1.67270),
            ("glass-SF10", 1.72825),
            ("glass-F11", 1.78472),
        ] {
            let index = known_spectrum(name).expect("known").at(LINE_D_NM);
            assert!((f64::from(index) - n_d).abs() < 2e-5, "{name}: {index}");
        }
    }

    #[test]
    fn metals_of_two_names_are_those() {
        assert_eq!(metal_of_names("metal-CuZn-eta", "metal-CuZn-k"), Some("CuZn"));
        assert_eq!(metal_of_names("metal-Cu-eta", "metal-Al-k"), None);
        assert!(["Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"].iter().all(|metal| {
            ["eta", "k"].iter().all(|part| known_spectrum(&format!("metal-{metal}-{part}")).is_some())
        }));
    }

    #[test]
    fn files_of_numbers_may_have_comments() {
        assert_eq!(spectrum_numbers("# lamp\n380 0.5 # low\n\n400,1e-1\r\n"), Ok(vec![380.0, 0.5, 400.0, 0.1]));
        assert_eq!(spectrum_numbers("380 0.5\n400 x"), Err("2: expected a finite number, found `x`".to_owned()));
    }
}
