//! What `measure sfr` finds.

use crate::measure::truth::place::Sought;
use etendue_metrology::sfr::Sfr;

/// An edge that was measured.
pub(super) struct Found<'a> {
    pub(super) sought: &'a Sought,
    pub(super) field: f64,
    pub(super) sfr: Sfr,
}
