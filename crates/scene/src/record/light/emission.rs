//! Emission of surfaces and the sky: strength and colour.

use std::path::PathBuf;

use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::{AssetKind, SpectrumValues};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{KnownNameRule, keyed, known, number, record, vector};
use crate::record::curve::{Curve, curve, spectrum_file};
use etendue_spectra::illuminant;

keyed! {
    /// Strength of the emission of a surface or of the sky.
    pub enum Level {
        /// Luminance; colour by one of "illuminant", "temperature_k", "rgb", "spectrum".
        luminance_cd_m2 => Luminance(Placed<f64>) = number("cd/m²").at_least(0.0);
        /// Spectral radiance.
        radiance_w_m2_sr_nm => Radiance(Curve) = curve(number("W·m⁻²·sr⁻¹·nm⁻¹").at_least(0.0));
        /// Luminous flux of each object's untextured surfaces of this material; not for an environment.
        luminous_flux_lm => LuminousFlux(Placed<f64>) = number("lm").at_least(0.0);
        /// Radiant flux, 300 to 1 100 nm, like the luminous flux.
        radiant_flux_w => RadiantFlux(Placed<f64>) = number("W").at_least(0.0);
    }
}

impl Level {
    /// Place in the description.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Luminance(level) | Self::LuminousFlux(level) | Self::RadiantFlux(level) => &level.place,
            Self::Radiance(Curve::Constant(level)) => &level.place,
            Self::Radiance(Curve::File(file)) => &file.place,
        }
    }
}

keyed! {
    /// The relative spectrum of a light.
    pub enum LightColour {
        /// Tabulated illuminant or lamp; "solar" is ASTM G-173 sunlight.
        illuminant => Illuminant(Placed<String>) = illuminants();
        /// Black-body temperature.
        temperature_k => Temperature(Placed<f64>) = number("K").at_least(500.0).at_most(20_000.0);
        /// Chromaticity, linear sRGB; not all 0.
        rgb => Rgb(Placed<[f64; 3]>) = vector::<3>(number("").at_least(0.0));
        /// Two columns: wavelength in nm, relative power.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
    }
}

/// The name of an illuminant.
pub(crate) fn illuminants() -> KnownNameRule {
    known("an illuminant", &[&["solar"], illuminant::names()].concat())
}

record! {
    /// Emission of a surface or of the sky, equal in all directions.
    pub struct Emission check(check_emission) {
        /// Strength.
        inside level: Level;
        /// Colour.
        group colour: LightColour;
    }
}

impl NamesFiles for Emission {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, level, colour } = self;
        if let Level::Radiance(curve) = level {
            curve.name_file(SpectrumValues::Light, files);
        }
        colour.name_files(files);
    }
}

impl NamesFiles for LightColour {
    fn name_files(&self, files: &mut FileList) {
        if let Self::Spectrum(file) = self {
            files.add(AssetKind::Spectrum(SpectrumValues::Light), file);
        }
    }
}

impl Level {
    /// Returns the key that needs a colour, and its place.
    fn colour_level(&self) -> Option<(&'static str, &Place)> {
        match self {
            Self::Luminance(v) => Some(("luminance_cd_m2", &v.place)),
            Self::LuminousFlux(v) => Some(("luminous_flux_lm", &v.place)),
            Self::RadiantFlux(v) => Some(("radiant_flux_w", &v.place)),
            Self::Radiance(_) => None,
        }
    }

    /// Returns the key that states a flux, which needs a surface of known area, and its place.
    #[must_use]
    pub fn flux(&self) -> Option<(&'static str, &Place)> {
        match self {
            Self::LuminousFlux(_) | Self::RadiantFlux(_) => self.colour_level(),
            Self::Luminance(_) | Self::Radiance(_) => None,
        }
    }
}

fn check_emission(emission: &Emission, errors: &mut DescriptionErrors) {
    match (emission.level.colour_level(), &emission.colour) {
        (Some((key, place)), None) => errors.add(
            ErrorCode::MissingKey,
            place,
            format!("\"{key}\" does not state the colour of the light"),
            "add one of \"illuminant\", \"temperature_k\", \"rgb\", \"spectrum\"",
        ),
        (None, Some(colour)) => errors.add(
            ErrorCode::Contradiction,
            colour.place(),
            "\"radiance_w_m2_sr_nm\" already states the spectrum; the colour contradicts it",
            "remove the colour, or give \"luminance_cd_m2\" instead of the radiance",
        ),
        _ => {}
    }
    emission.colour.iter().for_each(|c| check_colour(c, errors));
}

/// Refuses a black colour, which has no chromaticity.
pub(super) fn check_colour(colour: &LightColour, errors: &mut DescriptionErrors) {
    if let LightColour::Rgb(rgb) = colour
        && rgb.value == [0.0; 3]
    {
        errors.add(
            ErrorCode::Degenerate,
            &rgb.place,
            "found the colour black, which has no chromaticity",
            "give at least one of the three a value above 0",
        );
    }
}

impl LightColour {
    /// Place in the description.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Illuminant(v) => &v.place,
            Self::Temperature(v) => &v.place,
            Self::Rgb(v) => &v.place,
            Self::Spectrum(v) => &v.place,
        }
    }
}
