//! A quantity as a function of wavelength: constant, or tabulated in a file.

use std::path::PathBuf;

use crate::asset::file_list::FileList;
use crate::asset::request::{AssetKind, SpectrumValues};
use crate::place::Placed;
use crate::reader::{NumberRule, Rule, either, keyed, path, record, variant};

/// A quantity as a function of wavelength.
#[derive(Clone, Debug)]
pub enum Curve {
    /// Constant over wavelength.
    Constant(Placed<f64>),
    /// A table of wavelength (nm) and value.
    File(Placed<PathBuf>),
}

impl Curve {
    /// Requests its file, if any, whose values are `values`.
    pub(crate) fn name_file(&self, values: SpectrumValues, files: &mut FileList) {
        if let Self::File(file) = self {
            files.add(AssetKind::Spectrum(values), file);
        }
    }
}

keyed! {
    /// File of a tabulated curve.
    pub enum CurveFile {
        /// Two columns: wavelength in nm, value.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
    }
}

/// The path of a tabulated spectrum.
pub(crate) fn spectrum_file() -> impl Rule<Out = Placed<PathBuf>> {
    path(&["csv"])
}

/// A constant within the bounds of `constant`, or a file.
pub(crate) fn curve(constant: NumberRule) -> impl Rule<Out = Curve> {
    either(variant!(constant, Curve::Constant), variant!(record::<CurveFile>(), CurveFile::Spectrum => Curve::File))
}
