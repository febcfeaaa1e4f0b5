//! What the choice of wavelengths alone leaves of noise in a band.

use crate::plan::CameraPlan;
use crate::render::spectrum_spread::{SpectrumSpread, band_share};
use etendue_core::Bands;

/// The noise of a band of even light, as a part of a sentence.
pub(super) fn band_noise(camera: &CameraPlan, bands: Bands) -> String {
    let s = &camera.settings;
    // Each pass is spread by itself.
    if camera.pass_count() > 1 {
        return String::new();
    }
    let of = if s.folded { SpectrumSpread::most_band_noise } else { SpectrumSpread::band_noise };
    let noise = of(SpectrumSpread::of(camera), s.spp, s.replicates, s.wavelengths, band_share(s, bands));
    let Some(noise) = noise else { return String::new() };
    let most = if s.folded { "up to " } else { "" };
    format!(", each with {most}{:.1} % of noise in even light by the choice of wavelengths", 100.0 * noise)
}
