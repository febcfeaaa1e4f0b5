//! Spectra: light, tables beside the scene, coefficients.

use super::share::grey;
use super::stage::Scenery;
use etendue_scene::record::{Curve, LightColour};
use etendue_spectra::Spectrum;
use etendue_spectra::upsample::reflectance_spectrum;
use std::fmt::Write as _;

/// A light: its colour, and the luminance of one unit of it, cd/m². Zero luminance is no light.
pub(crate) struct LightUnit {
    pub(crate) colour: LightColour,
    pub(crate) luminance: f64,
}

/// A tabulated illuminant.
pub(crate) fn illuminant_of(name: &str) -> LightColour {
    LightColour::Illuminant(name.into())
}

impl Scenery {
    /// A file of a spectrum beside the scene; its path.
    pub(crate) fn spectrum_file(&mut self, points: &[(f64, f64)]) -> String {
        let mut text = "wavelength_nm,value\n".to_owned();
        points.iter().for_each(|(nm, value)| writeln!(text, "{nm},{value}").expect("a text grows"));
        let name = self.file_names.take("spectrum", "spectrum");
        self.add_file(format!("spectra/{name}.csv"), text.into_bytes())
    }

    /// A smooth spectrum as a table.
    pub(crate) fn smooth_file(&mut self, spectrum: &Spectrum, factor: f64) -> String {
        let points: Vec<(f64, f64)> =
            (60..=166).map(|i| 5 * i).map(|nm| (f64::from(nm), factor * f64::from(spectrum.at(nm as f32)))).collect();
        self.spectrum_file(&points)
    }

    /// A number, or a table.
    pub(crate) fn curve(&mut self, spectrum: &Spectrum, even: Option<f64>, factor: f64) -> Curve {
        match even {
            Some(even) => Curve::Constant((factor * even).into()),
            None => Curve::File(self.smooth_file(spectrum, factor).as_str().into()),
        }
    }
}

/// A coefficient, 0 or more, of three numbers; the second answer is the number where they are the same.
pub(crate) fn coefficient_of_rgb(name: &str, rgb: [f64; 3]) -> Result<(Spectrum, Option<f64>), String> {
    if rgb.iter().any(|v| *v < 0.0) {
        return Err(format!("\"{name}\" below 0"));
    }
    // As pbrt has colours beyond 1: a reflectance of half the largest, times twice that.
    let largest = rgb.iter().fold(0.0_f64, |most, v| most.max(*v));
    if let Some(even) = grey(rgb) {
        return Ok((Spectrum::from_fn(|_| even), Some(even)));
    }
    let reflectance = reflectance_spectrum(rgb.map(|v| (0.5 * v / largest) as f32));
    Ok((Spectrum::from_fn(|nm| 2.0 * largest * f64::from(reflectance.at(nm as f32))), None))
}
