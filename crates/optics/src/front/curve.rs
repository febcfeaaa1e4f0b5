//! A quantity over the wavelength.

use etendue_spectra::Spectrum;

/// A quantity that is the same at all wavelengths, exactly, or is tabulated.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// The same at all wavelengths.
    Constant(f64),
    /// Tabulated.
    Table(Box<Spectrum>),
}

impl Curve {
    /// Its value at a wavelength, nm.
    #[inline]
    #[must_use]
    pub fn at(&self, nm: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(spectrum) => f64::from(spectrum.at(nm as f32)),
        }
    }

    /// Whether it depends on the wavelength.
    #[must_use]
    pub fn varies(&self) -> bool {
        matches!(self, Self::Table(spectrum) if spectrum.min_value() != spectrum.max_value())
    }

    /// Least and greatest value.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Constant(value) => (*value, *value),
            Self::Table(spectrum) => (f64::from(spectrum.min_value()), f64::from(spectrum.max_value())),
        }
    }
}
