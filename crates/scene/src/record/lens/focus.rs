//! Focus distance of a lens.

use crate::place::Placed;
use crate::reader::{Rule, choice, either, number, variant, words};

/// Focus distance of a lens.
#[derive(Clone, Debug)]
pub enum FocusDistance {
    /// A finite distance, m.
    Metres(Placed<f64>),
    /// At infinity.
    Infinity,
}

words! {
    /// The word for an infinite distance.
    pub enum InfinityWord {
        /// Infinitely far.
        "infinity" => Infinity,
    }
}

pub(super) fn focus_distance() -> impl Rule<Out = FocusDistance> {
    let metres = variant!(number("m").above(0.0), FocusDistance::Metres);
    either(metres, variant!(choice::<InfinityWord>(), InfinityWord::Infinity == FocusDistance::Infinity))
}
