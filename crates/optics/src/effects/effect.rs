//! The effects that there are, and what a plan says about each.

use etendue_core::Verdict;

/// The effects that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Diffraction and wavefront error.
    PointSpread,
    /// Light scattered in the lens.
    Glare,
    /// Light that two surfaces reflect.
    Ghosts,
}

impl Effect {
    /// All effects, in their order.
    pub const ALL: [Self; 3] = [Self::PointSpread, Self::Glare, Self::Ghosts];

    /// The effect's name in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PointSpread => "point spread",
            Self::Glare => "veiling glare",
            Self::Ghosts => "ghosts",
        }
    }
}

/// What a plan says about an effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The effect.
    pub effect: Effect,
    /// Whether it is modelled.
    pub verdict: Verdict,
    /// Why, in words.
    pub reason: String,
}
