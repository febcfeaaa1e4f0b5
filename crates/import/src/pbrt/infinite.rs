//! Sum of the environment lights of a scene: ours has one.
//!
//! Uniform lights of one colour add their luminances, those of several colours their spectra. Images, with uniform lights added as linear sRGB, are resampled
//! into one image.

use etendue_scene::record::environment::EnvironmentImage;
use etendue_scene::record::{Curve, Emission, Environment, Level, LightColour};
use etendue_spectra::{Spectrum, illuminant, upsample};
use glam::DVec3;

use crate::scenery::{ImageLight, InfiniteLight, SceneBuilder, UniformLight};

/// Relative spectrum of a colour other than one in a file; dark for that.
pub(super) fn spectrum_of(colour: &LightColour) -> Spectrum {
    match colour {
        LightColour::Illuminant(name) => illuminant::by_name(&name.value).cloned(),
        LightColour::Temperature(kelvin) => Some(illuminant::blackbody(kelvin.value)),
        LightColour::Rgb(rgb) => Some(upsample::emission_spectrum(rgb.value.map(|v| v as f32))),
        LightColour::Spectrum(_) => None,
    }
    .unwrap_or_else(|| Spectrum::constant(0.0))
}

impl SceneBuilder {
    /// Gives the scene the sum of its environment lights.
    pub(super) fn join_infinite_lights(&mut self) -> Result<(), String> {
        let lights = std::mem::take(&mut self.known.infinite_lights);
        let count = lights.len();
        let (mut uniform, mut images) = (Vec::new(), Vec::new());
        for light in lights {
            match light {
                InfiniteLight::Uniform(light) => uniform.push(light),
                InfiniteLight::Image(light) => images.push(light),
            }
        }
        self.scene.environment = match (uniform.is_empty(), images.is_empty()) {
            (true, true) => None,
            (false, true) => Some(self.uniform_sum(uniform)),
            _ => Some(self.image_sum(&uniform, &images)?),
        };
        if count > 1 {
            self.report.note(format!("{count} environment lights become one, their sum"));
        }
        Ok(())
    }

    fn uniform_sum(&mut self, lights: Vec<UniformLight>) -> Environment {
        let luminance: f64 = lights.iter().map(|light| light.luminance_cd_m2).sum();
        if let [_] = lights[..] {
            let colour = lights.into_iter().map(|light| light.colour).next();
            return Environment::Uniform(Emission { colour, ..Emission::new(Level::Luminance(luminance.into())) });
        }
        let radiance: Vec<Spectrum> = lights.iter().map(UniformLight::radiance).collect();
        let sum = Spectrum::from_fn(|nm| radiance.iter().map(|light| f64::from(light.at(nm as f32))).sum());
        let points: Vec<(f64, f64)> = (300..=1100).map(|nm| (f64::from(nm), f64::from(sum.at(nm as f32)))).collect();
        let file = self.spectrum_file(&points);
        Environment::Uniform(Emission::new(Level::Radiance(Curve::File(file.as_str().into()))))
    }

    fn image_sum(&mut self, uniform: &[UniformLight], images: &[ImageLight]) -> Result<Environment, String> {
        let rows = images.iter().map(|image| image.rows).max().unwrap_or(1);
        // A single image keeps its numbers.
        let unit = if let ([image], []) = (images, uniform) { image.scale_cd_m2 } else { 1.0 };
        let constant = uniform.iter().map(UniformLight::linear_srgb).fold([0.0; 3], added);
        if constant.iter().any(|v| *v < 0.0) {
            self.report.note("colours of environment lights outside sRGB are limited to it where images are added");
        }
        let radiance = |direction: DVec3| {
            let value = images.iter().map(|image| (image.radiance)(direction).map(|v| v * image.scale_cd_m2 / unit));
            added(constant, value.fold([0.0; 3], added)).map(|v| v.max(0.0))
        };
        let path = self.environment_file(rows, &radiance)?;
        self.report
            .note(format!("environment: images are resampled to {} by {rows} pixels, 1 is {unit} cd/m²", 2 * rows));
        Ok(Environment::Image(EnvironmentImage::new(path.as_str(), unit)))
    }
}

fn added(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}
