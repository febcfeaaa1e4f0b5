//! `[render] wavelength_density`: the density of the wavelengths of pixels that accumulate electrons, and the estimated gain of including the source's
//! spectrum.
//!
//! A path's N wavelengths are rotations of one number u in the cumulative distribution of the density p. With the light f = R S ρ of a source S on a surface
//! of reflectance ρ, the path's electrons are h(u) = Σ f(λᵢ)/(N p(λᵢ)), with mean square ∫h² du. The light of a pixel's samples also varies between paths,
//! independently of u: with the relative variance v of that and q = ∫h²/(∫h)², the relative variance of a sample is (1 + v) q − 1. The ratio of q of two
//! densities is the gain of noisy pixels; in uniform light (v = 0), it is the ratio of q − 1, which is larger.

use super::context::Context;
use crate::plan::pixel_density::PixelDensity;
use crate::plan::{CameraPlan, SourceSpectra, SpectralGain, WavelengthSampling};
use etendue_core::WavelengthDensity;
use etendue_core::maths::f64::{exp, ln};
use etendue_scene::Description;
use etendue_scene::record::render;
use etendue_sensor::Sensor;
use etendue_spectra::{Spectrum, upsample};

/// Number of values of a path's first wavelength times its wavelengths.
const QUANTILES: usize = 4096;

/// Linear sRGB reflectances of surfaces: grey and three saturated colours.
const SURFACES: [[f32; 3]; 4] = [[0.5, 0.5, 0.5], [0.6, 0.05, 0.05], [0.05, 0.6, 0.05], [0.05, 0.05, 0.6]];

/// Chooses the density for all cameras, once all lights are known.
pub(super) fn choose(
    cameras: &mut [CameraPlan],
    sources: &SourceSpectra,
    description: &Description,
    context: &mut Context<'_>,
) {
    for camera in cameras {
        let requested = description.cameras[camera.index as usize].render.wavelength_density.as_ref();
        let settings = &camera.settings;
        let Some(sensor) = camera.summing_sensor() else {
            if let Some(requested) = requested.filter(|requested| requested.value != render::WavelengthDensity::Auto) {
                context.note_on(
                    &requested.place,
                    "this has no effect: no pixels sum electrons, so wavelengths are sampled uniformly",
                );
            }
            continue;
        };
        let keeps_bands = settings.bands.is_some();
        let density =
            PixelDensity { sampling: settings.wavelength_sampling, sources, range: settings.range, keeps_bands };
        let gain = spectral_gain(sensor, density, settings.wavelengths);
        camera.settings.wavelength_sampling =
            match requested.map_or(render::WavelengthDensity::Auto, |requested| requested.value) {
                render::WavelengthDensity::Uniform => WavelengthSampling::Uniform,
                render::WavelengthDensity::Response => WavelengthSampling::Response,
                render::WavelengthDensity::ResponseAndSource => WavelengthSampling::ResponseAndSource,
                render::WavelengthDensity::Auto
                    if !keeps_bands && gain.as_ref().is_some_and(SpectralGain::should_apply) =>
                {
                    WavelengthSampling::ResponseAndSource
                }
                render::WavelengthDensity::Auto => WavelengthSampling::Response,
            };
        camera.settings.spectral_gain = gain;
    }
}

/// Gain of a sensor's pixels with the source's spectrum in their density relative to the response alone; `None` if no source contributes.
fn spectral_gain(sensor: &Sensor, pixel_density: PixelDensity<'_>, wavelengths: u32) -> Option<SpectralGain> {
    let PixelDensity { sources, range, .. } = pixel_density;
    let surfaces = SURFACES.map(upsample::reflectance_spectrum);
    let rates = sensor.rate_responsivities();
    let (mut sum, mut sites, mut min, mut max) = (0.0, 0.0, f64::INFINITY, 0.0_f64);
    for (channel, responsivity) in rates.iter().enumerate() {
        let places = sensor.parameters().cfa.channels().iter().filter(|of| **of == channel).count() as f64;
        let density = |sampling| PixelDensity { sampling, ..pixel_density }.density(responsivity);
        let with = WavelengthSamples::new(&density(WavelengthSampling::ResponseAndSource), wavelengths as usize);
        let without = WavelengthSamples::new(&density(WavelengthSampling::Response), wavelengths as usize);
        let responses = sources.responses(responsivity, range);
        sites += if responses.is_empty() { 0.0 } else { places };
        for (group, surface) in responses.iter().flat_map(|group| surfaces.iter().map(move |surface| (group, surface)))
        {
            let light = group.product.product(surface);
            let gain = without.mean_square(&light) / with.mean_square(&light);
            if !gain.is_finite() {
                continue;
            }
            sum += places * group.weight * ln(gain) / surfaces.len() as f64;
            (min, max) = (min.min(gain), max.max(gain));
        }
    }
    (sites > 0.0 && max > 0.0).then(|| SpectralGain { mean: exp(sum / sites), min, max })
}

/// Wavelengths at equal steps of the cumulative distribution, with their densities.
struct WavelengthSamples {
    samples: Vec<(f32, f32)>,
    wavelengths: usize,
}

impl WavelengthSamples {
    fn new(density: &WavelengthDensity, wavelengths: usize) -> Self {
        let sample = |i: usize| {
            let drawn_nm = density.sample::<1>((i as f32 + 0.5) / QUANTILES as f32);
            (drawn_nm.nm[0], drawn_nm.pdf[0])
        };
        Self { samples: (0..QUANTILES).map(sample).collect(), wavelengths }
    }

    /// Mean square of a path's estimate of an integral, over its squared mean.
    fn mean_square(&self, light: &Spectrum) -> f64 {
        let paths = QUANTILES / self.wavelengths;
        let value = |(nm, pdf): (f32, f32)| f64::from(light.at(nm)) / f64::from(pdf);
        let path = |first: usize| (0..self.wavelengths).map(|i| value(self.samples[first + i * paths])).sum::<f64>();
        let (mut sum, mut squares) = (0.0, 0.0);
        for first in 0..paths {
            let h = path(first);
            sum += h;
            squares += h * h;
        }
        squares * paths as f64 / (sum * sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light in a quarter of the range, of uniform density: a single wavelength has a mean square of 4, four rotations always hit it once, and eight hit it
    /// twice.
    #[test]
    fn rotations_hit_a_quarter_of_the_range_once() {
        let uniform = WavelengthDensity::new(&[1.0], 400.0, 800.0).expect("a weight");
        let light = Spectrum::from_fn(|nm| if (500.0..600.0).contains(&nm) { 1.0 } else { 0.0 });
        for (wavelengths, exact) in [(1, 4.0), (4, 1.0), (8, 1.0)] {
            let q = WavelengthSamples::new(&uniform, wavelengths).mean_square(&light);
            // The edges of the light are 1 nm wide.
            assert!((q / exact - 1.0).abs() < 0.01, "{wavelengths}: {q}");
        }
    }
}
