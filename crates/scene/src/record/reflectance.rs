//! Reflectances: a number, a colour, a spectrum or a texture.

use std::path::PathBuf;

use super::curve::spectrum_file;
use crate::fault::{Faults, Named};
use crate::place::Placed;
use crate::reader::{Rule, RuleExt as _, either, keyed, name_of, number, record, vector};

/// The share of light that a surface reflects.
#[derive(Clone, Debug)]
pub enum Reflectance {
    /// The same at all wavelengths, 0 … 1.
    Grey(Placed<f64>),
    /// Linear sRGB, 0 … 1, made a smooth spectrum.
    LinearSrgb(Placed<[f64; 3]>),
    /// sRGB as encoded in pictures, 0 … 1, made a smooth spectrum.
    EncodedSrgb(Placed<[f64; 3]>),
    /// Tabulated over the wavelength.
    Spectrum(Placed<PathBuf>),
    /// A picture.
    Texture {
        /// The name of the texture.
        name: Placed<String>,
        /// A factor on the picture, 1 where it is not given.
        scale: Option<Placed<f64>>,
    },
}

record! {
    /// A reflectance that needs a word.
    pub struct ReflectanceTable check(check) {
        /// What it is.
        inside source: ReflectanceSource;
        /// A factor on a texture, above 0 and at most 1. Default: 1.
        optional scale: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

keyed! {
    /// What a reflectance is taken from.
    pub enum ReflectanceSource {
        /// The name of a texture.
        texture => Texture(Placed<String>) = name_of(Named::Texture);
        /// A colour as encoded in pictures (sRGB, 0 … 1), made a smooth spectrum.
        srgb => Srgb(Placed<[f64; 3]>) = vector::<3>(number("").at_least(0.0).at_most(1.0));
        /// A table of two columns, wavelength in nm and reflectance 0 … 1.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
    }
}

/// A number, `[r, g, b]` in linear sRGB, or a table.
pub(crate) fn reflectance() -> impl Rule<Out = Reflectance> {
    let share = number("").at_least(0.0).at_most(1.0);
    let colour = vector::<3>(share).map(Reflectance::LinearSrgb);
    either(share.map(Reflectance::Grey), either(colour, record::<ReflectanceTable>().map(ReflectanceTable::resolve)))
}

impl ReflectanceTable {
    fn resolve(self) -> Reflectance {
        match self.source {
            ReflectanceSource::Texture(name) => Reflectance::Texture { name, scale: self.scale },
            ReflectanceSource::Srgb(colour) => Reflectance::EncodedSrgb(colour),
            ReflectanceSource::Spectrum(file) => Reflectance::Spectrum(file),
        }
    }
}

fn check(table: &ReflectanceTable, faults: &mut Faults) {
    if let (Some(scale), false) = (&table.scale, matches!(table.source, ReflectanceSource::Texture(_))) {
        faults.add(&scale.place, "\"scale\" has no effect here, it belongs to \"texture\"", "remove it");
    }
}
