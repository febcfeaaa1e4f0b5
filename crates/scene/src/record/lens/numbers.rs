//! Numbers shared by several lenses.

use crate::reader::{NumberRule, number};

pub(super) fn focal_length() -> NumberRule {
    number("mm").above(0.0)
}

/// The f-number, at least 0.5: the cone of f/0.5 in air fills the half space.
pub(super) fn f_number() -> NumberRule {
    number("").at_least(0.5)
}

pub(super) fn fraction() -> NumberRule {
    number("").above(0.0).at_most(1.0)
}
