//! Numbers that several lenses have.

use crate::reader::{Number, number};

pub(super) fn focal_length() -> Number {
    number("mm").above(0.0)
}

/// No lens in air is faster than f/0.5: its cone fills the half space.
pub(super) fn f_number() -> Number {
    number("").at_least(0.5)
}

pub(super) fn share() -> Number {
    number("").above(0.0).at_most(1.0)
}
