//! By what the wavelengths of pixels that sum electrons are drawn, and what the light's spectrum saves there or would.

use super::words::ratio;
use crate::plan::{CameraPlan, SpectralGain, WavelengthSampling};

/// In words; `None` where no electrons are summed.
pub(super) fn wavelengths(camera: &CameraPlan) -> Option<String> {
    camera.summing_sensor()?;
    let gain = camera.spectral_gain.as_ref();
    Some(match (camera.settings.wavelength_sampling, gain) {
        (WavelengthSampling::Uniform, _) => "evenly over the range, as asked".to_owned(),
        (_, None) => "by the pixel's response".to_owned(),
        (WavelengthSampling::ResponseAndSource, Some(gain)) => {
            format!("by the pixel's response and the light's spectrum, which divides {}", saves(gain))
        }
        (WavelengthSampling::Response, Some(gain)) => {
            let why = match (gain.pays(), camera.settings.bands) {
                (false, _) if gain.is_felt() => "which may cost more than it saves",
                (false, _) => "too little",
                (true, Some(_)) => "but bands are kept, too",
                (true, None) => "but it is left out as asked",
            };
            format!("by the pixel's response; the light's spectrum would divide {}, {why}", saves(gain))
        }
    })
}

/// What it does to the variance of pixels whose samples differ much.
fn saves(gain: &SpectralGain) -> String {
    let SpectralGain { mean, least, most } = gain;
    format!("the variance of noisy pixels by {} ({} to {})", ratio(*mean), ratio(*least), ratio(*most))
}
