//! Status of an effect in a plan: whether it is modelled, the keys that disable it, and the error that results without it.

use std::fmt::{self, Display, Formatter};

/// Status of an effect, with the reason. Displayed as a plan words it: without the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EffectStatus {
    /// Always run; with the reason.
    Modelled(String),
    /// Run if a cheap test of the data requires it; with the reason.
    WhereNeeded(String),
    /// Absent, at no cost; with the reason.
    LeftOut(String),
    /// Absent, as the description does not mention it.
    NotDescribed,
}

impl EffectStatus {
    /// Returns true if the effect is run, always or if the data require it.
    #[must_use]
    pub fn is_modelled(&self) -> bool {
        matches!(self, Self::Modelled(_) | Self::WhereNeeded(_))
    }

    /// Reason, in words.
    #[must_use]
    pub fn reason(&self) -> &str {
        match self {
            Self::Modelled(reason) | Self::WhereNeeded(reason) | Self::LeftOut(reason) => reason,
            Self::NotDescribed => "not described",
        }
    }
}

impl Display for EffectStatus {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Modelled(_) => "modelled",
            Self::WhereNeeded(_) => "modelled where needed",
            Self::LeftOut(_) | Self::NotDescribed => "left out",
        })
    }
}

/// A change of a key of a camera file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyChange {
    /// The dotted key, as `sensor.lag`.
    pub key: &'static str,
    /// New value, as TOML spells it; `None`: the key is removed.
    pub value: Option<&'static str>,
}

impl KeyChange {
    /// Removes a key.
    #[must_use]
    pub fn removed(key: &'static str) -> Self {
        Self { key, value: None }
    }

    /// Sets to 0 the keys whose values are not 0.
    #[must_use]
    pub fn zeros<const N: usize>(keys: [(&'static str, f64); N]) -> Vec<Self> {
        keys.into_iter().filter(|(_, value)| *value != 0.0).map(|(key, _)| Self::zero(key)).collect()
    }

    /// Sets a key to 0.
    #[must_use]
    pub fn zero(key: &'static str) -> Self {
        Self { key, value: Some("0") }
    }
}

/// An error, or a bound of it, that follows from the plan's numbers.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct KnownError {
    /// Quantity that is wrong, in words.
    pub quantity: &'static str,
    /// Size of the error.
    pub value: f64,
    /// Its unit; empty for a ratio.
    pub unit: &'static str,
}

impl Display for KnownError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { quantity, value, unit } = self;
        write!(f, "{quantity} {}", three_digits(*value))?;
        if unit.is_empty() { Ok(()) } else { write!(f, " {unit}") }
    }
}

/// Formats a number: to three digits if it has a fraction.
fn three_digits(x: f64) -> String {
    match x.abs() {
        a if a >= 100.0 => format!("{x:.0}"),
        a if a >= 10.0 => format!("{x:.1}"),
        a if a >= 1.0 => format!("{x:.2}"),
        a if a >= 0.0005 || a == 0.0 => format!("{x:.3}"),
        _ => format!("{x:.1e}"),
    }
}
