//! What a plan says of an effect: only what a scene requires is modelled.

use std::fmt;

/// Whether an effect is modelled, and why. Displayed as a plan words it: without the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EffectStatus {
    /// Always run; with the reason.
    Modelled(String),
    /// Run where a cheap test of the data asks for it; with the reason.
    WhereNeeded(String),
    /// Absent, at no cost; with the reason.
    LeftOut(String),
    /// Absent, as the description says nothing of it.
    NotDescribed,
}

impl EffectStatus {
    /// Whether the effect is run, always or where the data ask for it.
    #[must_use]
    pub fn is_modelled(&self) -> bool {
        matches!(self, Self::Modelled(_) | Self::WhereNeeded(_))
    }

    /// Why, in words.
    #[must_use]
    pub fn reason(&self) -> &str {
        match self {
            Self::Modelled(reason) | Self::WhereNeeded(reason) | Self::LeftOut(reason) => reason,
            Self::NotDescribed => "not described",
        }
    }
}

impl fmt::Display for EffectStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Modelled(_) => "modelled",
            Self::WhereNeeded(_) => "where the data need it",
            Self::LeftOut(_) | Self::NotDescribed => "left out",
        })
    }
}
