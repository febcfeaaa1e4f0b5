//! Pictures as measurements see them.

use etendue_core::Plane;
use etendue_core::quantity::Quantity;

/// What one pixel of one channel says: a digital number, or a linear quantity in the unit that the owner states.
/// Digital numbers of up to 24 bits are exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading;

impl Quantity for Reading {
    type Sample = f32;
    const NAME: &'static str = "reading";
    const UNIT: &'static str = "DN or 1";
}

/// One channel of a picture.
pub type Image = Plane<Reading>;
