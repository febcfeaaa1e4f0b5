//! Spectra: light, tables in separate files, coefficients.
//!
//! Also images of plain numbers (roughness, opacity), from images that hold them as encoded colours.

use std::fmt::Write as _;

use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, encode_layers};
use etendue_scene::asset::ImageAsset;
use etendue_scene::record::{Curve, LightColour};
use etendue_spectra::{Spectrum, colour::decode, upsample::reflectance_spectrum};

use super::stored::stored_pixels;
use super::{stage::SceneBuilder, surfaces::grey};

/// Light: colour, and luminance of one unit, cd/m². Zero luminance means no light.
pub(crate) struct LightUnit {
    pub(crate) colour: LightColour,
    pub(crate) luminance: f64,
}

/// A tabulated illuminant.
pub(crate) fn illuminant_of(name: &str) -> LightColour {
    LightColour::Illuminant(name.into())
}

impl SceneBuilder {
    /// Writes a file of a spectrum next to the scene; returns its path.
    pub(crate) fn spectrum_file(&mut self, points: &[(f64, f64)]) -> String {
        let mut text = "wavelength_nm,value\n".to_owned();
        points.iter().for_each(|(nm, value)| writeln!(text, "{nm},{value}").expect("writing to a String succeeds"));
        let name = self.file_names.take("spectrum", "spectrum");
        self.add_file(format!("spectra/{name}.csv"), text.into_bytes())
    }

    /// Smooth spectrum as a table.
    pub(crate) fn smooth_file(&mut self, spectrum: &Spectrum, factor: f64) -> String {
        let points: Vec<(f64, f64)> =
            (60..=166).map(|i| 5 * i).map(|nm| (f64::from(nm), factor * f64::from(spectrum.at(nm as f32)))).collect();
        self.spectrum_file(&points)
    }

    /// Number, or table.
    pub(crate) fn curve(&mut self, spectrum: &Spectrum, even: Option<f64>, factor: f64) -> Curve {
        match even {
            Some(even) => Curve::Constant((factor * even).into()),
            None => Curve::File(self.smooth_file(spectrum, factor).as_str().into()),
        }
    }
}

/// Coefficient, 0 or more, from three numbers; the second value is the number if they are equal.
pub(crate) fn coefficient_from_rgb(name: &str, rgb: [f64; 3]) -> Result<(Spectrum, Option<f64>), String> {
    if rgb.iter().any(|v| *v < 0.0) {
        return Err(format!("\"{name}\" is below 0"));
    }
    // Like pbrt's colours beyond 1: a reflectance of half the largest, times twice that.
    let largest = rgb.iter().fold(0.0_f64, |max_so_far, v| max_so_far.max(*v));
    if let Some(even) = grey(rgb) {
        return Ok((Spectrum::from_fn(|_| even), Some(even)));
    }
    let reflectance = reflectance_spectrum(rgb.map(|v| (0.5 * v / largest) as f32));
    Ok((Spectrum::from_fn(|nm| 2.0 * largest * f64::from(reflectance.at(nm as f32))), None))
}

impl SceneBuilder {
    /// Writes an image of numbers computed by `number` from the linear red, green and blue of an sRGB-encoded image; returns the path of the file, which is
    /// grey.
    pub(crate) fn numbers_file(
        &mut self,
        image: &ImageAsset,
        preferred: &str,
        number: fn([f32; 3]) -> f32,
    ) -> Result<String, String> {
        let gray = |[r, g, b, _]: [f32; 4]| number([r, g, b].map(decode));
        let numbers: Vec<f32> = stored_pixels(image).into_iter().map(gray).collect();
        let layers = ["B", "G", "R"].map(|name| (name.to_owned(), ExrLayer::Float(&numbers)));
        let (width, height) = (image.width as usize, image.height as usize);
        let bytes = encode_layers(width, height, &layers, &Provenance::default()).map_err(|e| e.to_string())?;
        let own = self.file_names.take(preferred, "numbers");
        let path = self.add_file(format!("textures/{own}.exr"), bytes);
        self.check_size()?;
        Ok(path)
    }
}
