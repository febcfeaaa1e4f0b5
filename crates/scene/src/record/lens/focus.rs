//! Where a lens is focused.

use crate::place::Placed;
use crate::reader::{Rule, choice, either, number, variant, words};

/// Where a lens is focused.
#[derive(Clone, Debug)]
pub enum FocusDistance {
    /// At a distance, m.
    Metres(Placed<f64>),
    /// At infinity.
    Infinity,
}

words! {
    /// The word for a distance without end.
    pub enum Endless {
        /// Infinitely far.
        "infinity" => Infinity,
    }
}

pub(super) fn focus_distance() -> impl Rule<Out = FocusDistance> {
    let metres = variant!(number("m").above(0.0), FocusDistance::Metres);
    either(metres, variant!(choice::<Endless>(), Endless::Infinity == FocusDistance::Infinity))
}
