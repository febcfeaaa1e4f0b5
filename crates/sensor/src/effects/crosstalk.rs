//! Optical crosstalk: light that enters one pixel and is caught in its neighbour.
//!
//! Fractions of the mean photo-electrons go to the eight neighbours ([`Neighbours`]); energy is kept. At the array's edge
//! a pixel keeps what it has no neighbour for, as if the light beyond were the same.
//! Left out: dependence on wavelength and angle, neighbours farther away.

use super::neighbours::{Exchange, Neighbours};
use crate::check::Checks;
use crate::effect::{Action, Context, Effect, EffectOn, Memory, SensorFacts};
use crate::operation::Operation;
use crate::signal_breakdown::SignalComponent;
use etendue_core::EffectStatus;
use etendue_core::quantity::MeanElectrons;

/// Fractions of a pixel's light that its neighbours catch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crosstalk(pub Neighbours);

impl Effect for Crosstalk {
    const NAME: &'static str = "optical crosstalk";
    const KEY: &'static str = "sensor.crosstalk";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        self.0.check("crosstalk", checks);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(format!("{} of a pixel's light is caught in its neighbours", self.0.given()))
    }
}

impl EffectOn for Crosstalk {
    type On = MeanElectrons;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, _: &Context, _: &mut Memory) -> Action<MeanElectrons> {
        Action::plane(Exchange(self.0))
    }
}
