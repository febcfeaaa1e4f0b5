//! Response of a pixel: its voltage over its charge, in equivalent electrons at low light.
//!
//! - linear: v = e;
//! - knees: v = e up to the first knee, then straight lines of falling slopes (lateral overflow, stepped reset);
//! - logarithmic above a charge e₀: v = e up to e₀, v = e₀ (1 + ln(e/e₀)) above, with a continuous slope (pixels that become logarithmic when their
//!   transistor conducts, Kavadias et al. 2000).
//!
//! Acts after the well and before read noise, as in the pixel. Left out: differences of knees from pixel to pixel.

use etendue_core::EffectStatus;
use etendue_core::maths::f64::{exp, ln};
use etendue_core::quantity::{Charge, Voltage};

use crate::effect::{Effect, Row, RowConversion, SensorFacts};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// A change of slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knee {
    /// Charge of the knee, e⁻.
    pub at_e: f64,
    /// Slope above it, (0, 1).
    pub slope: f64,
}

/// Voltage over charge.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Response {
    /// Proportional.
    #[default]
    Linear,
    /// Straight lines, knees by increasing charge.
    Knees(Vec<Knee>),
    /// Logarithmic above a charge, e⁻.
    Logarithmic {
        /// Start of the logarithmic part, e⁻.
        from_e: f64,
    },
}

impl Response {
    /// Voltage of a charge, in equivalent electrons.
    #[must_use]
    pub fn voltage_e(&self, charge_e: f64) -> f64 {
        match self {
            Self::Linear => charge_e,
            Self::Logarithmic { from_e } if charge_e <= *from_e => charge_e,
            Self::Logarithmic { from_e } => from_e * (1.0 + ln(charge_e / from_e)),
            Self::Knees(knees) => {
                let (mut v, mut at, mut slope) = (0.0, 0.0, 1.0);
                for knee in knees.iter().take_while(|k| k.at_e < charge_e) {
                    v += slope * (knee.at_e - at);
                    (at, slope) = (knee.at_e, knee.slope);
                }
                v + slope * (charge_e - at)
            }
        }
    }

    /// Slope of the voltage over the charge.
    #[must_use]
    pub fn slope(&self, charge_e: f64) -> f64 {
        match self {
            Self::Logarithmic { from_e } => (from_e / charge_e.max(*from_e)).min(1.0),
            Self::Knees(knees) => knees.iter().rfind(|k| k.at_e < charge_e).map_or(1.0, |k| k.slope),
            Self::Linear => 1.0,
        }
    }

    /// The charge of a voltage, e⁻.
    #[must_use]
    pub fn charge_e(&self, voltage_e: f64) -> f64 {
        match self {
            Self::Linear => voltage_e,
            Self::Logarithmic { from_e } if voltage_e <= *from_e => voltage_e,
            Self::Logarithmic { from_e } => from_e * exp(voltage_e / from_e - 1.0),
            Self::Knees(knees) => {
                let (mut v, mut at, mut slope) = (0.0, 0.0, 1.0);
                for knee in knees {
                    let next = v + slope * (knee.at_e - at);
                    if next >= voltage_e {
                        break;
                    }
                    (v, at, slope) = (next, knee.at_e, knee.slope);
                }
                at + (voltage_e - v) / slope
            }
        }
    }

    /// The response as a conversion from charge to voltage; `None` if the values are the same.
    pub(crate) fn prepare(&self) -> Option<Self> {
        (*self != Self::Linear).then(|| self.clone())
    }
}

impl Effect for Response {
    const NAME: &'static str = "response";
    const KEY: &'static str = "sensor.response";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        match self {
            Self::Linear => {}
            Self::Logarithmic { from_e } => checks.positive("response.from_e", *from_e),
            Self::Knees(knees) => {
                let rising = knees.windows(2).all(|k| k[0].at_e < k[1].at_e && k[0].slope > k[1].slope);
                let legal = knees.iter().all(|k| k.at_e > 0.0 && k.at_e.is_finite() && k.slope > 0.0 && k.slope < 1.0);
                checks.agree("response.knees", rising && legal && !knees.is_empty(), || {
                    "charges must increase from above 0, and slopes must decrease from below 1 to above 0".to_owned()
                });
            }
        }
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        match self {
            Self::Linear => EffectStatus::LeftOut("voltage is proportional to charge".into()),
            Self::Logarithmic { from_e } => EffectStatus::Modelled(format!("logarithmic above {from_e} e⁻")),
            Self::Knees(knees) => {
                let list: Vec<_> = knees.iter().map(|k| format!("slope {} above {} e⁻", k.slope, k.at_e)).collect();
                EffectStatus::Modelled(list.join(", "))
            }
        }
    }
}

impl RowConversion for Response {
    type Input = Charge;
    type Output = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn convert<'a>(&self, row: Row<'a, Charge>) -> Row<'a, Voltage> {
        row.values.iter_mut().for_each(|e| *e = self.voltage_e(*e));
        row.sensed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_run_through_their_points_and_back() {
        let knees = Response::Knees(vec![Knee { at_e: 1000.0, slope: 0.25 }, Knee { at_e: 5000.0, slope: 0.01 }]);
        for (e, v) in [(-20.0, -20.0), (500.0, 500.0), (1000.0, 1000.0), (5000.0, 2000.0), (15_000.0, 2100.0)] {
            assert!((knees.voltage_e(e) - v).abs() < 1e-9);
        }
        let log = Response::Logarithmic { from_e: 100.0 };
        assert!((log.voltage_e(100.0 * core::f64::consts::E) - 200.0).abs() < 1e-9);
        for response in [knees, log, Response::Linear] {
            for e in [-5.0, 0.0, 50.0, 100.0, 999.0, 1001.0, 6000.0, 1e6] {
                assert!(
                    (response.charge_e(response.voltage_e(e)) - e).abs() < 1e-9 * e.abs().max(1.0),
                    "{response:?} {e}"
                );
            }
        }
    }
}
