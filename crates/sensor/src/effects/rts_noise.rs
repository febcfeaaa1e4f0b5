//! Random RTS noise: a trap at a pixel's transistor makes its voltage jump between two levels.
//!
//! e ← e ± a/2 for a fraction of pixels, a exponential of a stated mean, the level from a two-level state over frames
//! ([`two_level`]). The mean of both levels is the pixel's own. Draws: `Telegraph` (specimen), `TelegraphFlip`.

use super::two_level::{self, Draws, Site, TwoLevel, high_in_row};
use crate::check::Checks;
use crate::effect::{Action, Context, Effect, EffectOn, Memory, NOISE_OFF, Row, RowEffect, SensorFacts};
use crate::operation::Operation;
use crate::signal_breakdown::SignalComponent;
use etendue_core::EffectStatus;
use etendue_core::quantity::Voltage;
use etendue_core::random::NoiseDraw;

/// Pixels with RTS noise; the amplitude is in e⁻.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RtsNoise(pub TwoLevel);

impl Effect for RtsNoise {
    const NAME: &'static str = "RTS noise";
    const KEY: &'static str = "sensor.rts_noise";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        self.0.check(["rts_noise.share", "rts_noise.mean_e", "rts_noise.dwell_frames"], checks);
    }

    fn status(&self, facts: &SensorFacts, _: &Operation) -> EffectStatus {
        if !facts.noise {
            return EffectStatus::LeftOut(NOISE_OFF.into());
        }
        let TwoLevel { fraction, mean, dwell_frames } = self.0;
        let text = format!("{fraction} of pixels jump by {mean} e⁻ on average, every {dwell_frames} frames");
        EffectStatus::Modelled(text)
    }
}

impl EffectOn for RtsNoise {
    type On = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::Read;

    fn prepare(&self, context: &Context, memory: &mut Memory) -> Action<Voltage> {
        let draws = Draws { which: NoiseDraw::Telegraph, flip: NoiseDraw::TelegraphFlip };
        let (sites, high) = two_level::next(&self.0, draws, context, &memory.before.rts_noise_high);
        let jumps = PreparedRts::new(&sites, &high);
        memory.after.rts_noise_high = high;
        Action::rows(jumps)
    }
}

/// RTS noise, prepared: half the jump of each pixel, up or down.
#[derive(Clone, Debug, PartialEq)]
struct PreparedRts {
    halves: Vec<Site>,
}

impl PreparedRts {
    fn new(sites: &[Site], high: &[bool]) -> Self {
        let half =
            |(site, high): (&Site, &bool)| Site { amplitude: if *high { 0.5 } else { -0.5 } * site.amplitude, ..*site };
        Self { halves: sites.iter().zip(high).map(half).collect() }
    }
}

impl RowEffect<Voltage> for PreparedRts {
    fn apply(&self, row: &mut Row<'_, Voltage>) {
        for site in high_in_row(&self.halves, row.y) {
            row.values[site.x as usize] += site.amplitude;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::tests::{ADDRESS, quiet};
    use crate::sensor::Sensor;
    use crate::state::{FrameAddress, SensorState};
    use etendue_core::Plane;

    #[test]
    fn a_pixel_has_two_values_over_frames() {
        let mut p = quiet();
        (p.noise, p.read_out.black_level_dn) = (true, 1000.0);
        let two = TwoLevel { fraction: 0.1, mean: 200.0, dwell_frames: 3.0 };
        p.voltage.rts_noise = Some(RtsNoise(two));
        let sensor = Sensor::new(p).expect("legal");
        let mut state = SensorState::default();
        let mut seen = vec![std::collections::BTreeSet::new(); 32 * 32];
        for frame in 0..40 {
            let (next, raw) = sensor.step(state, &Plane::new(32, 32), FrameAddress { frame, ..ADDRESS });
            state = next;
            seen.iter_mut().zip(raw.plane.samples()).for_each(|(set, dn)| {
                set.insert(*dn);
            });
        }
        assert!(seen.iter().all(|set| set.len() <= 2));
        let jumping = seen.iter().filter(|set| set.len() == 2).count() as f64;
        // 102 ± 10 pixels; jumps below half a DN do not show (0.5 %), nor does a pixel that never jumps in 40 frames.
        assert!((jumping - 102.0).abs() < 40.0, "{jumping}");
        assert!(seen.iter().filter(|s| s.len() == 2).all(|s| s.iter().sum::<u32>().abs_diff(2000) <= 1));
    }
}
