//! `[render] wavelength_density`: by what the wavelengths of pixels that sum electrons are drawn.

use super::context::Context;
use crate::plan::{CameraPlan, SourceSpectra, SpectralGain, WavelengthSampling};
use crate::render::foretold_gain::spectral_gain;
use etendue_scene::Description;
use etendue_scene::record::render::WavelengthDensity;

/// Decides it for all cameras, once all light is known.
pub(super) fn choose(
    cameras: &mut [CameraPlan],
    sources: &SourceSpectra,
    description: &Description,
    context: &mut Context<'_>,
) {
    for camera in cameras {
        let asked = description.cameras[camera.index as usize].render.wavelength_density.as_ref();
        let settings = &camera.settings;
        let Some(sensor) = camera.summing_sensor() else {
            if let Some(asked) = asked.filter(|asked| asked.value != WavelengthDensity::Auto) {
                context
                    .remark_on(&asked.place, "no pixels sum electrons, so wavelengths lie evenly whatever this says");
            }
            continue;
        };
        let keeps_bands = settings.bands.is_some();
        let gain = spectral_gain(sensor, (sources, settings.range_nm), keeps_bands, settings.wavelengths);
        camera.settings.wavelength_sampling = match asked.map_or(WavelengthDensity::Auto, |asked| asked.value) {
            WavelengthDensity::Uniform => WavelengthSampling::Uniform,
            WavelengthDensity::Response => WavelengthSampling::Response,
            WavelengthDensity::ResponseAndSource => WavelengthSampling::ResponseAndSource,
            WavelengthDensity::Auto if !keeps_bands && gain.as_ref().is_some_and(SpectralGain::pays) => {
                WavelengthSampling::ResponseAndSource
            }
            WavelengthDensity::Auto => WavelengthSampling::Response,
        };
        camera.spectral_gain = gain;
    }
}
