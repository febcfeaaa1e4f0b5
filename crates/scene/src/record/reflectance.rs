//! Reflectances: a number, a colour, a spectrum or a texture.

use std::path::PathBuf;

use super::curve::spectrum_file;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::{AssetKind, SpectrumValues};
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::{Place, Placed};
use crate::reader::{NumberRule, Rule, RuleExt as _, either, keyed, known, name_of, number, record, variant, vector};
use etendue_spectra::reflectance;

/// Reflectance or transmittance of a surface.
#[derive(Clone, Debug)]
pub enum Reflectance {
    /// Constant over the surface.
    Plain(Colour),
    /// An image.
    Texture {
        /// Name of the texture.
        name: Placed<String>,
        /// Factor on the image, 1 if absent.
        scale: Option<Placed<f64>>,
    },
}

/// A fraction of light by wavelength, 0 … 1.
#[derive(Clone, Debug)]
pub enum Colour {
    /// Constant over wavelength.
    Grey(Placed<f64>),
    /// Linear sRGB, converted to a smooth spectrum.
    LinearSrgb(Placed<[f64; 3]>),
    /// sRGB as encoded in images, converted to a smooth spectrum.
    EncodedSrgb(Placed<[f64; 3]>),
    /// Tabulated over the wavelength.
    Spectrum(Placed<PathBuf>),
    /// Typical of a material, by name.
    Named(Placed<String>),
}

impl Colour {
    /// Place in the description.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Grey(v) => &v.place,
            Self::LinearSrgb(v) | Self::EncodedSrgb(v) => &v.place,
            Self::Spectrum(v) => &v.place,
            Self::Named(v) => &v.place,
        }
    }
}

impl NamesFiles for Colour {
    fn name_files(&self, files: &mut FileList) {
        if let Self::Spectrum(file) = self {
            files.add(AssetKind::Spectrum(SpectrumValues::Share), file);
        }
    }
}

impl NamesFiles for Reflectance {
    fn name_files(&self, files: &mut FileList) {
        if let Self::Plain(colour) = self {
            colour.name_files(files);
        }
    }
}

record! {
    /// A reflectance given by a table.
    pub struct ReflectanceTable check(check) {
        /// Source.
        inside source: ReflectanceSource;
        /// Factor on the texture. Default: 1.
        optional scale: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

keyed! {
    /// Source of a reflectance.
    pub enum ReflectanceSource {
        /// Name of a texture.
        texture => Texture(Placed<String>) = name_of(NameKind::Texture);
        /// Encoded sRGB colour, converted to a smooth spectrum.
        srgb => Srgb(Placed<[f64; 3]>) = vector::<3>(fraction());
        /// Two columns: wavelength in nm, reflectance 0 … 1.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
        /// A spectrum of the library.
        named => Named(Placed<String>) = known("a material of the library", reflectance::names());
    }
}

keyed! {
    /// Source of a colour.
    pub enum ColourTable {
        /// Encoded sRGB colour, converted to a smooth spectrum.
        srgb => Srgb(Placed<[f64; 3]>) = vector::<3>(fraction());
        /// Two columns: wavelength in nm, fraction of light 0 … 1.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
        /// A spectrum of the library.
        named => Named(Placed<String>) = known("a material of the library", reflectance::names());
    }
}

fn fraction() -> NumberRule {
    number("").at_least(0.0).at_most(1.0)
}

/// A number, `[r, g, b]` in linear sRGB, or a table.
pub(crate) fn any_reflectance() -> impl Rule<Out = Reflectance> {
    let texture = record().map(ReflectanceTable::resolve, ReflectanceTable::from_reflectance);
    either(variant!(grey(), Reflectance::Plain), either(variant!(linear_srgb(), Reflectance::Plain), texture))
}

/// The same without textures.
pub(crate) fn any_colour() -> impl Rule<Out = Colour> {
    either(grey(), either(linear_srgb(), record().map(ColourTable::resolve, ColourTable::from_colour)))
}

/// A number.
fn grey() -> impl Rule<Out = Colour> {
    variant!(fraction(), Colour::Grey)
}

/// `[r, g, b]`.
fn linear_srgb() -> impl Rule<Out = Colour> {
    variant!(vector::<3>(fraction()), Colour::LinearSrgb)
}

impl ColourTable {
    fn resolve(self) -> Colour {
        match self {
            Self::Srgb(v) => Colour::EncodedSrgb(v),
            Self::Spectrum(v) => Colour::Spectrum(v),
            Self::Named(v) => Colour::Named(v),
        }
    }

    /// Returns the table form of a colour; `None` for forms that are no table.
    fn from_colour(colour: &Colour) -> Option<Self> {
        match colour {
            Colour::EncodedSrgb(v) => Some(Self::Srgb(v.clone())),
            Colour::Spectrum(v) => Some(Self::Spectrum(v.clone())),
            Colour::Named(v) => Some(Self::Named(v.clone())),
            Colour::Grey(_) | Colour::LinearSrgb(_) => None,
        }
    }
}

impl ReflectanceTable {
    /// Returns the table form of a reflectance; `None` for forms that are no table.
    fn from_reflectance(reflectance: &Reflectance) -> Option<Self> {
        match reflectance {
            Reflectance::Texture { name, scale } => {
                Some(Self { scale: scale.clone(), ..Self::new(ReflectanceSource::Texture(name.clone())) })
            }
            Reflectance::Plain(Colour::EncodedSrgb(v)) => Some(Self::new(ReflectanceSource::Srgb(v.clone()))),
            Reflectance::Plain(Colour::Spectrum(v)) => Some(Self::new(ReflectanceSource::Spectrum(v.clone()))),
            Reflectance::Plain(Colour::Named(v)) => Some(Self::new(ReflectanceSource::Named(v.clone()))),
            Reflectance::Plain(Colour::Grey(_) | Colour::LinearSrgb(_)) => None,
        }
    }

    fn resolve(self) -> Reflectance {
        match self.source {
            ReflectanceSource::Texture(name) => Reflectance::Texture { name, scale: self.scale },
            ReflectanceSource::Srgb(colour) => Reflectance::Plain(Colour::EncodedSrgb(colour)),
            ReflectanceSource::Spectrum(file) => Reflectance::Plain(Colour::Spectrum(file)),
            ReflectanceSource::Named(name) => Reflectance::Plain(Colour::Named(name)),
        }
    }
}

fn check(table: &ReflectanceTable, errors: &mut DescriptionErrors) {
    if let (Some(scale), false) = (&table.scale, matches!(table.source, ReflectanceSource::Texture(_))) {
        errors.add(
            ErrorCode::NoEffect,
            &scale.place,
            "\"scale\" has no effect here, it belongs to \"texture\"",
            "remove it",
        );
    }
}
