//! What a plan says of an effect: only what a scene requires is modelled.

use std::fmt;

/// Whether an effect is modelled. Displayed as a plan words it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Always run.
    Required,
    /// A cheap test of the data decides.
    Guarded,
    /// Absent, and costs nothing.
    Skipped,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Required => "modelled",
            Self::Guarded => "where the data need it",
            Self::Skipped => "left out",
        })
    }
}
