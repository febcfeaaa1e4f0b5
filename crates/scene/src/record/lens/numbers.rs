//! Numbers shared by several lenses.

use crate::reader::{Number, number};

pub(super) fn focal_length() -> Number {
    number("mm").above(0.0)
}

/// The f-number, at least 0.5: the cone of f/0.5 in air fills the half space.
pub(super) fn f_number() -> Number {
    number("").at_least(0.5)
}

pub(super) fn share() -> Number {
    number("").above(0.0).at_most(1.0)
}
