//! Why depth cannot be compared.

/// Why depth cannot be judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// Pictures of different sizes.
    #[error("the estimate is {} × {} pixels, the truth {} × {}: both must have one size", estimate.0, estimate.1, truth.0, truth.1)]
    Size {
        /// Width and height of the estimate.
        estimate: (usize, usize),
        /// Width and height of the truth.
        truth: (usize, usize),
    },
    /// No pixel has both.
    #[error("no pixel away from edges has a finite depth above zero in both pictures: are these depths in metres?")]
    Nothing,
    /// Ranges that do not rise.
    #[error("the limits of the ranges must rise from 0 or more, two or more of them")]
    Ranges,
    /// A setting that is no such number.
    #[error("{name}: expected a finite number of {least} or more, not {value}")]
    Setting {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The least that it may be.
        least: &'static str,
    },
    /// The same picture twice.
    #[error("the estimate is the truth, pixel by pixel: give two different pictures")]
    Same,
}
