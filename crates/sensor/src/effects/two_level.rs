//! Pixels that jump at random between two levels: a random telegraph signal over frames.
//!
//! A fraction of pixels is affected; each has its own amplitude (exponential) and level. From frame to frame it changes its level with probability
//! 1/dwell, so it stays at each for a mean of `dwell` frames; before the first frame both are equally likely. The choice of pixels and the amplitudes
//! belong to the unit; the jumps belong to the frames. Left out: unequal dwell times of the two levels, more than two levels.
//!
//! RTS noise: a trap at a pixel's transistor makes its voltage jump between two levels.
//!
//! e ← e ± a/2 for a fraction of pixels, a exponential of a stated mean, the level from a two-level state over frames ([`TwoLevel`]). The mean of
//! both levels is the pixel's own value. Random numbers: `Telegraph` (unit), `TelegraphFlip`.

use etendue_core::random::{NoiseDraw, Pixel};
use etendue_core::{EffectStatus, quantity::Voltage};

use crate::effect::{Action, Context, Effect, Memory, NOISE_OFF, QuantityEffect, Row, RowEffect, SensorFacts};
use crate::{capture::Operation, check::Checks, random::pattern, signal_breakdown::SignalComponent};

/// Pixels that jump between two levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoLevel {
    /// Fraction of affected pixels, above 0 and up to 1.
    pub fraction: f64,
    /// Mean of their amplitudes, from the lower level to the upper one, in the unit of the affected quantity.
    pub mean: f64,
    /// Mean number of frames at a level, 1 or more.
    pub dwell_frames: f64,
}

impl TwoLevel {
    /// `keys`: those of the fraction, the mean and the dwell.
    pub(crate) fn check(&self, keys: [&'static str; 3], checks: &mut Checks) {
        checks.fraction_above_0(keys[0], self.fraction);
        checks.positive(keys[1], self.mean);
        let legal = self.dwell_frames.is_finite() && self.dwell_frames >= 1.0;
        checks.legal(keys[2], self.dwell_frames, legal, "a number of frames of at least 1");
    }
}

/// A pixel and its amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RtsPixel {
    pub(crate) x: u32,
    pub(crate) y: u32,
    pub(crate) amplitude: f64,
}

/// The random numbers of a kind of two-level pixels: their selection, and the jumps.
pub(crate) struct RandomPurposes {
    pub(crate) which: NoiseDraw,
    pub(crate) flip: NoiseDraw,
}

/// The sites of a capture's array, and those at their upper level, given the levels `before` in the last frame.
pub(crate) fn next_levels(
    two: &TwoLevel,
    purposes: RandomPurposes,
    context: &Context,
    before: &[bool],
) -> (Vec<RtsPixel>, Vec<bool>) {
    let key = context.pattern(purposes.which);
    let mut sites = Vec::new();
    for y in 0..context.height as u32 {
        pattern::each(key, y, two.fraction, context.width, |x, stream| {
            sites.push(RtsPixel { x: x as u32, y, amplitude: pattern::exponential(two.mean, stream) });
        });
    }
    // All captures of a frame see the same level.
    let flips = context.frame_noise(purposes.flip);
    let random = |site: &RtsPixel| flips.stream(Pixel { x: site.x, y: site.y }).unit_f64();
    let high = if before.len() == sites.len() {
        sites.iter().zip(before).map(|(site, high)| high ^ (random(site) * two.dwell_frames < 1.0)).collect()
    } else {
        sites.iter().map(|site| random(site) < 0.5).collect()
    };
    (sites, high)
}

/// The sites of row `y` that are at their upper level.
pub(crate) fn high_in_row(sites: &[RtsPixel], y: u32) -> &[RtsPixel] {
    let start = sites.partition_point(|site| site.y < y);
    let end = sites.partition_point(|site| site.y <= y);
    &sites[start..end]
}

/// Pixels with RTS noise; the amplitude is in e⁻.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RtsNoise(pub TwoLevel);

impl Effect for RtsNoise {
    const NAME: &'static str = "RTS noise";
    const KEY: &'static str = "sensor.rts_noise";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        self.0.check(["rts_noise.fraction", "rts_noise.mean_e", "rts_noise.dwell_frames"], checks);
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

impl QuantityEffect for RtsNoise {
    type Signal = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::Read;

    fn prepare(&self, context: &Context, memory: &mut Memory) -> Action<Voltage> {
        let purposes = RandomPurposes { which: NoiseDraw::Telegraph, flip: NoiseDraw::TelegraphFlip };
        let (sites, high) = next_levels(&self.0, purposes, context, &memory.before.rts_noise_high);
        let jumps = PreparedRts::new(&sites, &high);
        memory.after.rts_noise_high = high;
        Action::rows(jumps)
    }
}

/// RTS noise, prepared: half the jump of each pixel, up or down.
#[derive(Clone, Debug, PartialEq)]
struct PreparedRts {
    halves: Vec<RtsPixel>,
}

impl PreparedRts {
    fn new(sites: &[RtsPixel], high: &[bool]) -> Self {
        let half = |(site, high): (&RtsPixel, &bool)| RtsPixel {
            amplitude: if *high { 0.5 } else { -0.5 } * site.amplitude,
            ..*site
        };
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
    use etendue_core::Plane;

    use super::*;
    use crate::capture::{FrameAddress, SensorState};
    use crate::frame::tests::{ADDRESS, quiet};
    use crate::{parameters::tests::ideal, sensor::Sensor};

    #[test]
    fn levels_stay_for_their_dwell_and_are_as_likely_as_each_other() {
        let two = TwoLevel { fraction: 0.05, mean: 3.0, dwell_frames: 4.0 };
        let p = ideal();
        let frame = |frame: u32, before: &[bool]| {
            let purposes = RandomPurposes { which: NoiseDraw::Telegraph, flip: NoiseDraw::TelegraphFlip };
            let address = FrameAddress { seed: 1, camera: 0, frame, capture: 0 };
            let operation = p.operation(p.described_point());
            next_levels(
                &two,
                purposes,
                &Context { facts: p.facts(), operation, address, width: 200, height: 200 },
                before,
            )
        };
        let (sites, mut high) = frame(0, &[]);
        let n = sites.len() as f64;
        // 40 000 pixels: 2000 ± 44; four of those.
        assert!((n - 2000.0).abs() < 175.0, "{n}");
        let mean = sites.iter().map(|s| s.amplitude).sum::<f64>() / n;
        assert!((mean / 3.0 - 1.0).abs() < 4.0 / n.sqrt());
        let (mut up, mut jumps) = (0.0, 0.0);
        for k in 1..=50 {
            let (same, next) = frame(k, &high);
            assert_eq!(same, sites, "the pattern is the specimen's");
            jumps += high.iter().zip(&next).filter(|(a, b)| a != b).count() as f64;
            up += next.iter().filter(|h| **h).count() as f64;
            high = next;
        }
        // 50 n jumps of probability 1/4. The fraction at the upper level is correlated over (1 + r)/(1 − r) = 3 frames, r = 1 − 2/4.
        assert!((jumps / (50.0 * n) - 0.25).abs() < 4.0 * (0.1875 / (50.0 * n)).sqrt());
        assert!((up / (50.0 * n) - 0.5).abs() < 4.0 * (0.25 * 3.0 / (50.0 * n)).sqrt());
    }

    #[test]
    fn a_pixel_has_two_values_over_frames() {
        let mut p = quiet();
        (p.noise, p.read_out.black_level_dn) = (true, 1000.0);
        let two = TwoLevel { fraction: 0.1, mean: 200.0, dwell_frames: 3.0 };
        p.voltage.rts_noise = Some(RtsNoise(two));
        let sensor = Sensor::new(p).expect("legal");
        let mut state = SensorState::default();
        let mut levels = vec![std::collections::BTreeSet::new(); 32 * 32];
        for frame in 0..40 {
            let (next, raw) = sensor.step(state, &Plane::new(32, 32), FrameAddress { frame, ..ADDRESS });
            state = next;
            levels.iter_mut().zip(raw.plane.samples()).for_each(|(set, dn)| {
                set.insert(*dn);
            });
        }
        assert!(levels.iter().all(|set| set.len() <= 2));
        let jumping = levels.iter().filter(|set| set.len() == 2).count() as f64;
        // 102 ± 10 pixels; jumps below half a DN are invisible (0.5 %), as is a pixel that never jumps in 40 frames.
        assert!((jumping - 102.0).abs() < 40.0, "{jumping}");
        assert!(levels.iter().filter(|s| s.len() == 2).all(|s| s.iter().sum::<u32>().abs_diff(2000) <= 1));
    }
}
