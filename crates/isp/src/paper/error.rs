//! Why a filter cannot be applied, and what it works on.

/// What a filter works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Linear light, before the tone curve; white is 1 and more is possible.
    Linear,
    /// The encoded picture, 0 to 1.
    Display,
}

/// Why a filter cannot be applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// A number out of its range.
    #[error("{name} is {value}, but a number {range} is needed")]
    Range {
        /// Which number.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it should be.
        range: &'static str,
    },
    /// A filter of linear light after one of the encoded picture.
    #[error(
        "filter {0} (from 1) works on linear light, but one before it on the encoded picture: give glow, tone map, drops and linear colour first"
    )]
    Order(usize),
    /// A conversion that belongs to the other stage.
    #[error("conversions to and from {space} are for {wanted}: set \"on\" accordingly")]
    Space {
        /// The colour space.
        space: &'static str,
        /// The stage it is made for.
        wanted: &'static str,
    },
}

/// Refuses a number outside a range.
pub(super) fn demand(legal: bool, name: &'static str, value: f64, range: &'static str) -> Result<(), FilterError> {
    if legal && value.is_finite() { Ok(()) } else { Err(FilterError::Range { name, value, range }) }
}
