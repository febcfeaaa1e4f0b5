//! Inter-pixel capacitance: the voltage of a pixel is seen by its neighbours too.
//!
//! Shares of the voltage are exchanged with the eight neighbours ([`Neighbours`]) after the well and the response: counts
//! and their noise are made before it, so it correlates noise without adding any (Moore, Ninkov and Forrest 2006). Sums are kept.
//! Left out: dependence on the signal.

use super::Verdict;
use super::neighbours::Neighbours;
use crate::check::Checks;
use crate::parameters::SensorParameters;

/// Shares of a pixel's voltage that couple to its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterPixelCapacitance(pub Neighbours);

impl InterPixelCapacitance {
    pub(crate) fn check(&self, checks: &mut Checks) {
        self.0.check("inter_pixel_capacitance", checks);
    }
}

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    match p.read_out.capacitance {
        None => (Verdict::Skipped, super::NOT_DESCRIBED.into()),
        Some(c) => (Verdict::Required, format!("{} of a pixel's voltage couples to its neighbours", c.0.given())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::tests::{ADDRESS, covariance, one_dn_an_electron, run};
    use etendue_core::Plane;

    #[test]
    fn noise_is_correlated_and_the_variance_falls() {
        let mut p = one_dn_an_electron();
        let shares = Neighbours { horizontal: 0.01, vertical: 0.01, corner: 0.0 };
        p.read_out.capacitance = Some(InterPixelCapacitance(shares));
        let raw = run(&p, &Plane::filled(512, 512, 10_000.0), ADDRESS);
        // White noise of variance μ through the kernel: Σ k² at no shift, 2 k₀ k₁ at a shift of one (and 1/12 of rounding).
        let (own, one) = (0.96, 0.01);
        let variance = 10_000.0 * (own * own + 4.0 * one * one) + 1.0 / 12.0;
        // A variance of n numbers is known to √(2/n) = 0.28 %, a covariance to √(1/n) = 0.2 % of the variance; four of each.
        assert!((covariance(&raw, 0, 0) / variance - 1.0).abs() < 0.011);
        assert!((covariance(&raw, 1, 0) - 10_000.0 * 2.0 * own * one).abs() < 78.0);
        assert!((covariance(&raw, 0, 1) - 10_000.0 * 2.0 * own * one).abs() < 78.0);
    }
}
