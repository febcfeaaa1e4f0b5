//! Errors of charts.

/// Reason why a chart cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChartError {
    /// A size or number that is not valid for the chart.
    #[error("`{option}` {value}: {expected}")]
    Option {
        /// Name of the option's field.
        option: &'static str,
        /// Given value.
        value: String,
        /// Expected value and remedy.
        expected: String,
    },
    /// The camera does not look at a sheet in front of it.
    #[error("{0}")]
    Camera(String),
}

impl ChartError {
    /// An option with an invalid value.
    pub fn option(option: &'static str, value: impl ToString, expected: impl Into<String>) -> Self {
        Self::Option { option, value: value.to_string(), expected: expected.into() }
    }
}
