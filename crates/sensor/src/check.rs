//! Errors of a sensor, and the checks that find them.

/// An error of a sensor.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SensorError {
    /// A number outside its range.
    #[error("{key} is {value}, but {expected} is needed")]
    Range {
        /// The parameter.
        key: &'static str,
        value: f64,
        /// The legal range.
        expected: &'static str,
    },
    /// A quantum efficiency outside 0 to 1.
    #[error(
        "the quantum efficiency of channel {channel} runs from {low} to {high}, but must stay within 0 to 1: give it in electrons per photon"
    )]
    Efficiency {
        /// The channel's name.
        channel: String,
        /// Its smallest value.
        low: f32,
        /// Its largest value.
        high: f32,
    },
    /// A channel number in the tile without a channel.
    #[error(
        "the colour filter tile refers to channel {channel}, but the channels are numbered from 0 and their number is {channels}"
    )]
    NoSuchChannel {
        /// The channel's number.
        channel: usize,
        /// Number of channels.
        channels: usize,
    },
    /// A channel that no pixel has.
    #[error("channel {0} has no pixel in the colour filter tile: remove it or place it")]
    UnusedChannel(String),
    /// Parameters that contradict each other.
    #[error("{key}: {problem}")]
    Conflict {
        /// The parameter to be changed.
        key: &'static str,
        /// Problem and remedy.
        problem: String,
    },
}

impl SensorError {
    /// The key concerned, by its path below `[sensor]` in a camera file, such as `dark.temperature_c`; for a list of tables without an index.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::Range { key, .. } | Self::Conflict { key, .. } => key,
            Self::Efficiency { .. } => "quantum_efficiency",
            Self::NoSuchChannel { .. } | Self::UnusedChannel(_) => "cfa",
        }
    }
}

/// Collects the errors of a sensor's parameters.
#[derive(Debug, Default)]
pub(crate) struct Checks {
    pub(crate) errors: Vec<SensorError>,
}

impl Checks {
    /// Refuses `value` unless it is `legal`.
    pub(crate) fn legal(&mut self, key: &'static str, value: f64, legal: bool, expected: &'static str) {
        if !legal {
            self.errors.push(SensorError::Range { key, value, expected });
        }
    }

    pub(crate) fn positive(&mut self, key: &'static str, value: f64) {
        self.legal(key, value, value.is_finite() && value > 0.0, "a finite number above 0");
    }

    pub(crate) fn not_negative(&mut self, key: &'static str, value: f64) {
        self.legal(key, value, value.is_finite() && value >= 0.0, "a finite number of at least 0");
    }

    pub(crate) fn fraction(&mut self, key: &'static str, value: f64) {
        self.legal(key, value, (0.0..=1.0).contains(&value), "a fraction from 0 to 1");
    }

    pub(crate) fn fraction_above_0(&mut self, key: &'static str, value: f64) {
        self.legal(key, value, value > 0.0 && value <= 1.0, "a fraction above 0 and up to 1");
    }

    /// Refuses a combination unless it is `legal`.
    pub(crate) fn agree(&mut self, key: &'static str, legal: bool, problem: impl FnOnce() -> String) {
        if !legal {
            self.errors.push(SensorError::Conflict { key, problem: problem() });
        }
    }
}
