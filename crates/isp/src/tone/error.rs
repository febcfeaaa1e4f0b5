//! Why points or parameters are no tone curve.

/// Why a curve cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ToneError {
    /// γ out of range.
    #[error("gamma is {0}, but a finite number above 0 is needed")]
    Gamma(f64),
    /// Parameters of an S-curve out of range.
    #[error("an S-curve of contrast {contrast} about {midpoint}: contrast must be above 0, midpoint between 0 and 1")]
    SCurve {
        /// Slope at the middle.
        contrast: f64,
        /// The middle.
        midpoint: f64,
    },
    /// Too few points.
    #[error("a tone table of {0} points: at least two are needed")]
    Short(usize),
    /// Inputs that do not rise, outputs that fall, or numbers that are not finite.
    #[error("point {0} of the tone table (from 1): inputs must rise from point to point, and outputs never fall")]
    Order(usize),
    /// A table that does not cover the range.
    #[error("a tone table leads from input 0 to input 1 with outputs from 0 to 1; this one has {0}")]
    Range(&'static str),
}
