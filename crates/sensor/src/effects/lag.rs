//! Lag: charge that traps hold and release in later frames (image retention, persistence).
//!
//! For each kind of trap k, with capture fraction f_k and time constant τ_k, and frames T apart, a pixel's charge q and its trapped
//! charge Q_k become
//!
//! - released: r_k = Q_k (1 − exp(−T/τ_k)), added to the pixel;
//! - captured: c_k = f_k min(q + Σ r, full well), taken from it; Q_k ← Q_k − r_k + c_k.
//!
//! Several captures of a pixel's single photodiode follow each other at equal parts of the frame period, and share its traps. Charge is conserved:
//! q + Σ Q_k before is q + Σ Q_k after. (The linear limit of the trap model in Pyxel's `persistence` and of Smith et al. 2008.) Left out: shot noise
//! of capture and release, traps that fill up, dependence on temperature.

use etendue_core::{EffectStatus, Plane, maths::f64::exp, quantity::Charge};
use rayon::prelude::*;

use crate::capture::{Operation, SensorState};
use crate::effect::{Action, Context, Effect, Memory, PlaneEffect, QuantityEffect, SensorFacts, Traces};
use crate::{check::Checks, signal_breakdown::SignalComponent};

/// A kind of trap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trap {
    /// Fraction of a frame's charge captured, above 0; all kinds together at most 0.5.
    pub fraction: f64,
    /// Time after which 1/e of the charge is left, s.
    pub time_constant_s: f64,
}

/// Traps that hold charge from frame to frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lag {
    /// The kinds of traps; empty: none.
    pub traps: Vec<Trap>,
}

impl Lag {
    /// Total fraction captured by all traps.
    fn total_fraction(&self) -> f64 {
        self.traps.iter().map(|trap| trap.fraction).sum()
    }
}

impl Effect for Lag {
    const NAME: &'static str = "lag";
    const KEY: &'static str = "sensor.lag";

    fn check(&self, facts: &SensorFacts, checks: &mut Checks) {
        for trap in &self.traps {
            checks.fraction_above_0("lag.fraction", trap.fraction);
            checks.positive("lag.time_constant_s", trap.time_constant_s);
            checks.agree("lag", facts.frame_period_s.is_some(), || {
                "the released charge depends on the time between frames: give \"frame_period_s\"".to_owned()
            });
            checks.agree("lag", !facts.is_split_pixel, || {
                "the traps are those of one photodiode, but a capture of another sensitivity has a separate photodiode: remove one of the two".to_owned()
            });
        }
        let total = self.total_fraction();
        let legal = total <= 0.5 || self.traps.is_empty();
        checks.agree("lag", legal, || format!("the traps retain {total} in total: give at most 0.5"));
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        if self.traps.is_empty() {
            return EffectStatus::NotDescribed;
        }
        let kind = |t: &Trap| format!("{} of the charge for about {} s", t.fraction, t.time_constant_s);
        let kinds: Vec<_> = self.traps.iter().map(kind).collect();
        EffectStatus::Modelled(format!("traps retain {}", kinds.join(", ")))
    }
}

impl QuantityEffect for Lag {
    type Signal = Charge;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Charge> {
        let frame_s = context.facts.frame_period_s.expect("checked with the parameters");
        let period_s = frame_s / context.facts.exposures as f64;
        let kinds = self.traps.iter().map(|t| (t.fraction, 1.0 - exp(-period_s / t.time_constant_s)));
        Action::plane(PreparedTraps { kinds: kinds.collect(), full_well_e: context.operation.full_well_e })
    }
}

#[derive(Clone, Debug, PartialEq)]
struct PreparedTraps {
    /// Fraction captured, and fraction released.
    kinds: Vec<(f64, f64)>,
    full_well_e: f64,
}

impl PlaneEffect<Charge> for PreparedTraps {
    fn apply(&self, mut plane: Plane<Charge>, traces: &mut Traces<'_>) -> Plane<Charge> {
        self.exchange(&mut plane, traces.after);
        plane
    }
}

impl PreparedTraps {
    /// Exchanges charge with the traps of each pixel.
    fn exchange(&self, plane: &mut Plane<Charge>, after: &mut SensorState) {
        let trapped_e = &mut after.trapped_e;
        let size = plane.samples().len();
        if trapped_e.len() != self.kinds.len() || trapped_e.iter().any(|kind| kind.len() != size) {
            *trapped_e = vec![vec![0.0; size]; self.kinds.len()];
        }
        // Kinds one after the other: all release first, then each captures from the remaining charge.
        for (kind, (_, released)) in trapped_e.iter_mut().zip(&self.kinds) {
            kind.par_iter_mut().zip(plane.samples_mut().par_iter_mut()).for_each(|(trapped, q)| {
                let back = (f64::from(*trapped) * released) as f32;
                (*trapped, *q) = (*trapped - back, *q + back);
            });
        }
        let total: f64 = self.kinds.iter().map(|(caught, _)| caught).sum();
        for (kind, (caught, _)) in trapped_e.iter_mut().zip(&self.kinds) {
            kind.par_iter_mut().zip(plane.samples().par_iter()).for_each(|(trapped, q)| {
                *trapped += (caught * f64::from(*q).min(self.full_well_e)) as f32;
            });
        }
        let well = self.full_well_e;
        plane.samples_mut().par_iter_mut().for_each(|q| *q -= (total * f64::from(*q).min(well)) as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::{FrameAddress, SensorState};
    use crate::frame::tests::{ADDRESS, quiet};
    use crate::sensor::Sensor;

    fn lagging() -> Sensor {
        let mut p = quiet();
        (p.exposure.frame_period_s, p.charge.full_well.capacity_e) = (Some(0.04), 1e6);
        p.charge.lag.traps =
            vec![Trap { fraction: 0.05, time_constant_s: 0.04 }, Trap { fraction: 0.01, time_constant_s: 1.0 }];
        Sensor::new(p).expect("legal")
    }

    /// Two captures per frame: in the dark, traps hold as much from frame to frame as with one.
    #[test]
    fn captures_share_the_time_of_a_frame() {
        use crate::hdr::{Capture, HighDynamicRange};
        let mut p = lagging().parameters().clone();
        p.read_out.bits = 20;
        p.charge.lag.traps.remove(0);
        let second = Capture { exposure_ratio: 0.5, ..Capture::default() };
        let again = Capture { gain_ratio: 0.5, dual_conversion_gain: true, ..Capture::default() };
        p.hdr = HighDynamicRange { captures: vec![second, again], bits: Some(24), ..HighDynamicRange::default() };
        let sensor = Sensor::new(p.clone()).expect("legal");
        let trapped = SensorState { trapped_e: vec![vec![1000.0; 4]], ..SensorState::default() };
        let (after, _) = sensor.step(trapped, &Plane::new(2, 2), FrameAddress { frame: 1, ..ADDRESS });
        // A time constant of one second, two captures of 20 ms; each captures 1 % of the released charge.
        let half = exp(-0.02);
        let expected = 1000.0 * (half + 0.01 * (1.0 - half)) * (half + 0.01 * (1.0 - half));
        assert!((f64::from(after.trapped_e[0][0]) - expected).abs() < 1e-3, "{} {expected}", after.trapped_e[0][0]);
        p.hdr.captures[0].sensitivity_ratio = 0.5;
        assert!(Sensor::new(p).is_err());
    }

    #[test]
    fn a_flash_fades_by_its_time_constants_and_no_charge_is_lost() {
        let sensor = lagging();
        let (mut state, first) =
            sensor.step(SensorState::default(), &Plane::filled(2, 2, 100_000.0), FrameAddress { frame: 0, ..ADDRESS });
        assert_eq!(first.plane.at(0, 0), 94_000);
        let (mut charge, mut fast, mut slow) = (94_000.0, 5000.0, 1000.0);
        for frame in 1..200 {
            let (next, raw) = sensor.step(state, &Plane::new(2, 2), FrameAddress { frame, ..ADDRESS });
            state = next;
            let (a, b) = (fast * (1.0 - exp(-1.0)), slow * (1.0 - exp(-0.04)));
            let read = (a + b) * 0.94;
            fast += 0.05 * (a + b) - a;
            slow += 0.01 * (a + b) - b;
            charge += read;
            // The ADC rounds to one electron.
            assert!(
                (f64::from(raw.plane.at(1, 1)) - read).abs() <= 0.51,
                "frame {frame}: {} {read}",
                raw.plane.at(1, 1)
            );
        }
        let trapped_e: f64 = state.trapped_e.iter().map(|kind| f64::from(kind[0])).sum();
        // Charges are f32: each of 200 frames rounds by at most 100 000 · 2⁻²⁴.
        assert!((charge + trapped_e - 100_000.0).abs() < 1.2, "{}", charge + trapped_e);
    }
}
