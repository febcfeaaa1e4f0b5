//! Optical crosstalk: light that enters one pixel and is caught in its neighbour.
//!
//! Shares of the mean photo-electrons go to the eight neighbours ([`Neighbours`]); energy is kept. At the array's edge
//! a pixel keeps what it has no neighbour for, as if the light beyond were the same.
//! Left out: dependence on wavelength and angle, neighbours farther away.

use super::Verdict;
use super::neighbours::Neighbours;
use crate::check::Checks;
use crate::parameters::SensorParameters;

/// Shares of a pixel's light that its neighbours catch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crosstalk(pub Neighbours);

impl Crosstalk {
    pub(crate) fn check(&self, checks: &mut Checks) {
        self.0.check("crosstalk", checks);
    }
}

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    match p.optics.crosstalk {
        None => (Verdict::Skipped, super::NOT_DESCRIBED.into()),
        Some(c) => (Verdict::Required, format!("{} of a pixel's light is caught in its neighbours", c.0.given())),
    }
}
