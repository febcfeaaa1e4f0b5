//! Why a chart cannot be made.

/// Why a chart cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChartError {
    /// A size or number that the chart cannot have.
    #[error("`{option}` {value}: {expected}")]
    Option {
        /// The name of the option's field.
        option: &'static str,
        /// What was given.
        value: String,
        /// What is expected, and what to do.
        expected: String,
    },
    /// The camera does not look at a sheet in front of it.
    #[error("{0}")]
    Camera(String),
}

impl ChartError {
    /// An option with a value it cannot have.
    pub fn option(option: &'static str, value: impl ToString, expected: impl Into<String>) -> Self {
        Self::Option { option, value: value.to_string(), expected: expected.into() }
    }
}
