//! Text on the light of a camera: its owner, the reason for which a camera with the same view has its own, and the density of its wavelengths.

use super::list;
use super::words::ratio;
use crate::compile::shared_light::own_light_reason;
use crate::plan::Settings;
use crate::plan::pixel_density::UNIFORM_FRACTION_WITH_BANDS;
use crate::plan::{CameraPlan, Plan};
use crate::plan::{SpectralGain, WavelengthSampling};
use crate::sizes::spectrum_spread::SpectrumSpread;
use etendue_core::Bands;

/// Another camera of the plan whose film serves this one; `None` if it has its own.
pub(super) fn light_provider<'a>(plan: &'a Plan, camera: &CameraPlan) -> Option<&'a CameraPlan> {
    plan.cameras.iter().find(|other| other.light == camera.light).filter(|other| other.index != camera.index)
}

/// Text on a camera's light; `None` if it is its own and no other camera's is nearly the same.
pub(super) fn light(plan: &Plan, camera: &CameraPlan) -> Option<String> {
    if !camera.is_first_with_light() {
        let owner = &camera.light.camera;
        return Some(match light_provider(plan, camera) {
            Some(_) => format!("that of camera {owner}: rendered once, with the same Monte Carlo errors"),
            None => format!("equal to that of camera {owner} of the job, with the same random numbers"),
        });
    }
    own_light_reason(plan, camera)
        .map(|(other, unlike)| format!("separate: camera {other} has the same view, but differs in {}", list(&unlike)))
}

/// Further cameras that a film serves, as a part of a sentence.
pub(super) fn other_users(plan: &Plan, camera: &CameraPlan) -> String {
    let others: Vec<&str> = plan
        .cameras
        .iter()
        .filter(|other| other.light == camera.light && other.index != camera.index)
        .map(|other| other.name.as_str())
        .collect();
    match others.len() {
        0 => String::new(),
        1..=4 => format!(", shared with {}", list(&others)),
        n => format!(", shared with {n} more cameras: {} to {}", others[0], others[n - 1]),
    }
}

/// Returns the density of wavelengths of pixels that accumulate electrons, and the actual or possible gain of the light's spectrum there; `None` if no
/// electrons are accumulated.
pub(super) fn wavelengths(camera: &CameraPlan) -> Option<String> {
    camera.summing_sensor()?;
    let gain = camera.settings.spectral_gain.as_ref();
    Some(match (camera.settings.wavelength_sampling, gain) {
        (WavelengthSampling::Uniform, _) => "uniform over the range, as requested".to_owned(),
        (_, None) => "sampled in proportion to the pixel's response".to_owned(),
        (WavelengthSampling::ResponseAndSource, Some(gain)) => {
            format!(
                "sampled in proportion to the pixel's response and the source spectrum, which divides {}",
                saves(gain)
            )
        }
        (WavelengthSampling::Response, Some(gain)) => {
            let why = match (gain.should_apply(), camera.settings.bands) {
                (false, _) if gain.is_gain() => "which may cost more than it saves",
                (false, _) => "too little to be used",
                (true, Some(_)) => "but bands are stored, too",
                (true, None) => "but it is left out as requested",
            };
            format!(
                "sampled in proportion to the pixel's response; the source spectrum as a further factor would divide \
                 {}, {why}",
                saves(gain)
            )
        }
    })
}

/// Effect on the variance of pixels whose samples differ much.
fn saves(gain: &SpectralGain) -> String {
    let SpectralGain { mean, min, max } = gain;
    format!("the variance of noisy pixels by {} ({} to {})", ratio(*mean), ratio(*min), ratio(*max))
}

/// Returns the noise from the choice of wavelengths alone in a band of uniform light, as a part of a sentence.
pub(super) fn band_noise(camera: &CameraPlan, bands: Bands) -> String {
    let s = &camera.settings;
    // Each pass is spread by itself.
    if camera.pass_count() > 1 {
        return String::new();
    }
    let of = if s.accumulates_electrons { SpectrumSpread::max_band_noise } else { SpectrumSpread::band_noise };
    let noise = of(camera.spectrum_spread(), s.spp, s.replicates, s.wavelengths, band_fraction(s, bands));
    let Some(noise) = noise else { return String::new() };
    let prefix = if s.accumulates_electrons { "up to " } else { "" };
    format!(", each with {prefix}{:.1} % of noise from wavelength sampling under uniform illumination", 100.0 * noise)
}

/// Minimum fraction of the density of wavelengths in a band: if electrons are accumulated in addition to bands, half of the density follows the pixel's
/// response, which may be zero there.
fn band_fraction(settings: &Settings, bands: Bands) -> f64 {
    let uniform_fraction = bands.width_nm() / settings.range.width_nm();
    if settings.accumulates_electrons { UNIFORM_FRACTION_WITH_BANDS * uniform_fraction } else { uniform_fraction }
}
