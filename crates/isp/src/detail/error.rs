//! Why detail cannot be treated so.

/// Why detail cannot be treated so.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DetailError {
    /// A length or share out of its range.
    #[error("{name} is {value}, but a number {range} is needed")]
    Range {
        /// Which number.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it should be.
        range: &'static str,
    },
}

/// Refuses a number that is not within `low` (excluded) and `high`.
pub(super) fn within(
    name: &'static str,
    value: f64,
    low: f64,
    high: f64,
    range: &'static str,
) -> Result<(), DetailError> {
    if value > low && value <= high { Ok(()) } else { Err(DetailError::Range { name, value, range }) }
}
