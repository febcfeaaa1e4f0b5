//! The light that a camera was measured by.

use etendue_spectra::{Spectrum, illuminant};

/// Wavelengths of averages, nm apart.
const STEP_NM: usize = 5;

/// The light that was measured by, as told.
pub(crate) struct Light {
    pub wavelength_nm: Option<f64>,
    pub illuminant: Option<String>,
}

/// The light's spectrum.
pub(crate) fn spectrum(light: &str) -> Result<&'static Spectrum, String> {
    let unknown = || format!("`illuminant` {light}: give one of {}", illuminant::names().join(", "));
    illuminant::named(light).ok_or_else(unknown)
}

/// Light of a spectrum that a pixel sees, by wavelength, nm.
pub(crate) fn weighed(light: &Spectrum, responsivity: &Spectrum) -> impl Iterator<Item = (f64, f64)> {
    (300..=1100)
        .step_by(STEP_NM)
        .map(move |nm| (f64::from(light.at(nm as f32) * responsivity.at(nm as f32)), f64::from(nm)))
}
