//! Why a model cannot be.

/// A number of a model that it cannot have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value}; expected {expected}")]
pub struct ModelError {
    /// The parameter's name.
    pub name: String,
    /// The value it was given.
    pub value: f64,
    /// What is legal.
    pub expected: &'static str,
}

impl ModelError {
    pub(crate) fn value(name: &str, value: f64, expected: &'static str) -> Self {
        Self { name: name.to_owned(), value, expected }
    }
}

/// Largest size of a parameter: squares of more overflow, and no camera has it.
const LARGEST: f64 = 1e30;

/// Refuses what is not finite, or too large to be calculated with.
pub(crate) fn finite<'a>(values: impl IntoIterator<Item = (&'a str, f64)>) -> Result<(), ModelError> {
    match values.into_iter().find(|(_, value)| value.is_nan() || value.abs() > LARGEST) {
        Some((name, value)) if value.is_finite() => {
            Err(ModelError::value(name, value, "a number of at most 1e30 in size"))
        }
        Some((name, value)) => Err(ModelError::value(name, value, "a finite number")),
        None => Ok(()),
    }
}

/// Refuses a value for which `legal` does not hold.
pub(crate) fn legal(name: &str, value: f64, legal: bool, expected: &'static str) -> Result<(), ModelError> {
    if legal && value.is_finite() { Ok(()) } else { Err(ModelError::value(name, value, expected)) }
}

/// Names for the coefficients of a list, from `first`.
pub(crate) fn numbered<'a>(letter: &str, first: usize, values: &'a [f64]) -> Vec<(String, &'a f64)> {
    values.iter().enumerate().map(|(i, value)| (format!("{letter}{}", i + first), value)).collect()
}

/// Refuses a list in which a coefficient is not finite.
pub(crate) fn finite_list(letter: &str, first: usize, values: &[f64]) -> Result<(), ModelError> {
    let named = numbered(letter, first, values);
    finite(named.iter().map(|(name, value)| (name.as_str(), **value)))
}
