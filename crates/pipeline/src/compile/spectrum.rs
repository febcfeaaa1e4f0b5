//! Curves and colours of light: from records to spectra.

use super::context::{Context, ErrorCode};
use core::f64::consts::FRAC_1_PI;
use etendue_core::WavelengthRange;
use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_scene::record::{Curve, Emission, Level, LightColour};
use etendue_scene::{Place, Placed};
use etendue_spectra::{Extrapolation, Spectrum, illuminant, observer, upsample};
use std::path::PathBuf;

/// A quantity over wavelength; `outside` states how a table continues beyond its ends.
pub(super) fn curve(curve: &Curve, outside: Extrapolation, context: &mut Context<'_>) -> Option<Spectrum> {
    match curve {
        Curve::Constant(value) => Some(Spectrum::constant(value.value)),
        Curve::File(file) => from_file(file, outside, context),
    }
}

/// A tabulated spectrum.
pub(super) fn from_file(file: &Placed<PathBuf>, outside: Extrapolation, context: &mut Context<'_>) -> Option<Spectrum> {
    let Some(asset) = context.assets.spectra.get(&file.value) else {
        context.error(ErrorCode::UnreadableFile, &file.place, "the spectrum was not loaded", "give a readable file");
        return None;
    };
    if let (Some(first), Some(last)) = (asset.points.first(), asset.points.last()) {
        context.coverage.add(&file.value, WavelengthRange::new(first.0, last.0), outside);
    }
    context.accept(&file.place, Spectrum::from_points(&asset.points, outside))
}

/// Relative spectrum of a light's colour.
pub(super) fn relative(colour: &LightColour, context: &mut Context<'_>) -> Option<Spectrum> {
    match colour {
        LightColour::Illuminant(name) => named_illuminant(name, context),
        LightColour::Temperature(kelvin) => Some(illuminant::blackbody(kelvin.value)),
        LightColour::Rgb(rgb) => Some(upsample::emission_spectrum(rgb.value.map(|v| v as f32))),
        LightColour::Spectrum(file) => from_file(file, Extrapolation::Zero, context),
    }
}

/// An illuminant of the library; "solar" is the direct beam of ASTM G-173.
pub(super) fn named_illuminant(name: &Placed<String>, context: &mut Context<'_>) -> Option<Spectrum> {
    if name.value == "solar" {
        return Some(illuminant::solar().direct.clone());
    }
    let spectrum = illuminant::by_name(&name.value).cloned();
    if spectrum.is_none() {
        let problem = format!("there is no illuminant \"{}\"", name.value);
        context.error(
            ErrorCode::UnknownName,
            &name.place,
            problem,
            format!("give one of solar, {}", illuminant::names().join(", ")),
        );
    }
    spectrum
}

/// Radiance of a surface or of the sky, W·m⁻²·sr⁻¹·nm⁻¹; for a stated flux that of a surface of 1 m² with one emissive side (a flux Φ from an area A leaves
/// with L = Φ / (π A)).
pub(super) fn emitted(emission: &Emission, context: &mut Context<'_>) -> Option<Spectrum> {
    let level = match &emission.level {
        Level::Radiance(radiance) => return curve(radiance, Extrapolation::Zero, context),
        // A level without a colour was refused when it was read.
        Level::Luminance(level) | Level::LuminousFlux(level) | Level::RadiantFlux(level) => level,
    };
    let relative = relative(emission.colour.as_ref()?, context)?;
    match &emission.level {
        Level::RadiantFlux(_) => Some(scaled_to_power(&relative, level.value * FRAC_1_PI)),
        Level::LuminousFlux(_) => scaled_to_luminance(&relative, level.value * FRAC_1_PI, &level.place, context),
        Level::Luminance(_) | Level::Radiance(_) => scaled_to_luminance(&relative, level.value, &level.place, context),
    }
}

/// A relative spectrum scaled to a luminance (cd/m²) or an illuminance (lx).
pub(super) fn scaled_to_luminance(
    relative: &Spectrum,
    level: f64,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<Spectrum> {
    let scaled = observer::with_luminance(relative, level);
    if scaled.is_none() {
        let problem = "the spectrum of this light has no visible part, so it cannot be scaled to a luminance";
        context.error(ErrorCode::Degenerate, place, problem, "state its strength in W (radiance or irradiance)");
    }
    scaled
}

/// A relative spectrum scaled to a power summed over all legal wavelengths.
pub(super) fn scaled_to_power(relative: &Spectrum, total: f64) -> Spectrum {
    relative.scaled(total / relative.integral(MIN_NM, MAX_NM))
}
