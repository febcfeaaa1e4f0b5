//! A quantity over the wavelength: the same everywhere, or tabulated in a file.

use std::path::PathBuf;

use crate::asset::file_list::FileList;
use crate::asset::request::{AssetKind, Values};
use crate::place::Placed;
use crate::reader::{Number, Rule, RuleExt as _, either, keyed, path, record};

/// A quantity over the wavelength.
#[derive(Clone, Debug)]
pub enum Curve {
    /// The same at all wavelengths.
    Constant(Placed<f64>),
    /// A table of wavelength (nm) and value.
    File(Placed<PathBuf>),
}

impl Curve {
    /// Requests its file, whose values are `values`, where it has one.
    pub(crate) fn name_file(&self, values: Values, files: &mut FileList) {
        if let Self::File(file) = self {
            files.add(AssetKind::Spectrum(values), file);
        }
    }
}

keyed! {
    /// Where a curve is tabulated.
    pub enum CurveFile {
        /// A table of two columns, wavelength in nm and value, linear between the points.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
    }
}

/// The path of a tabulated spectrum.
pub(crate) fn spectrum_file() -> impl Rule<Out = Placed<PathBuf>> {
    path(&["csv"])
}

/// A constant within the bounds of `constant`, or a file.
pub(crate) fn curve(constant: Number) -> impl Rule<Out = Curve> {
    either(constant.map(Curve::Constant), record::<CurveFile>().map(|CurveFile::Spectrum(f)| Curve::File(f)))
}
