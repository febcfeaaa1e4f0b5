//! A quantity over the wavelength: the same everywhere, or tabulated in a file.

use std::path::PathBuf;

use crate::place::Placed;
use crate::reader::{Number, Rule, either, keyed, path, record, variant};

/// A quantity over the wavelength.
#[derive(Clone, Debug)]
pub enum Curve {
    /// The same at all wavelengths.
    Constant(Placed<f64>),
    /// A table of wavelength (nm) and value.
    File(Placed<PathBuf>),
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
    either(variant!(constant, Curve::Constant), variant!(record::<CurveFile>(), CurveFile::Spectrum => Curve::File))
}
