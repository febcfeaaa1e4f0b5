//! Inter-pixel capacitance: the voltage of a pixel is seen by its neighbours too.
//!
//! Fractions of the voltage are exchanged with the eight neighbours ([`Neighbours`]) after the well and the response: counts
//! and their noise are made before it, so it correlates noise without adding any (Moore, Ninkov and Forrest 2006). Sums are kept.
//! Left out: dependence on the signal.

use super::neighbours::{Exchange, Neighbours};
use crate::check::Checks;
use crate::effect::{Action, Context, Effect, EffectOn, Memory, SensorFacts};
use crate::operation::Operation;
use crate::signal_breakdown::SignalComponent;
use etendue_core::EffectStatus;
use etendue_core::quantity::Voltage;

/// Fractions of a pixel's voltage that couple to its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterPixelCapacitance(pub Neighbours);

impl Effect for InterPixelCapacitance {
    const NAME: &'static str = "inter-pixel capacitance";
    const KEY: &'static str = "sensor.inter_pixel_capacitance";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        self.0.check("inter_pixel_capacitance", checks);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(format!("{} of a pixel's voltage couples to its neighbours", self.0.given()))
    }
}

impl EffectOn for InterPixelCapacitance {
    type On = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, _: &Context, _: &mut Memory) -> Action<Voltage> {
        Action::plane(Exchange(self.0))
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
        let given = Neighbours { horizontal: 0.01, vertical: 0.01, corner: 0.0 };
        p.voltage.capacitance = Some(InterPixelCapacitance(given));
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
