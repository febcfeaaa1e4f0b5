//! Automatic exposure: time and gain that bring a percentile of the image to a target.
//!
//! After a frame, ℓ is the level below which a fraction p of the image's pixels lies, as a fraction of the range from black to white. With E the
//! product of time and gain, the next frame has E ← E (target/ℓ)^d, d the damping in (0, 1], the factor limited to 1/16 to 16. Time is changed first,
//! then gain, each within its limits: t = clamp(E/g_min), g = clamp(E/t). Where ℓ is white, target/ℓ is the target itself: the control lowers E by
//! that factor per frame until the level is below white. Left out: metering by region, flicker avoidance, delays of more than a frame, steps of
//! lines.

use etendue_core::{EffectStatus, maths::f64::pow};

use crate::capture::{OperatingPoint, Operation};
use crate::effect::{Effect, SensorFacts};
use crate::{check::Checks, raw::Raw};

/// Automatic control of exposure from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExposureControl {
    /// Percentile of the image's levels that is brought to the target, (0, 100).
    pub percentile: f64,
    /// Target level, as a fraction of the range from black to white, (0, 1).
    pub target: f64,
    /// Exponent of a frame's correction, (0, 1].
    pub damping: f64,
    /// Shortest and longest time, s.
    pub exposure_s: [f64; 2],
    /// Smallest and largest analogue gain.
    pub analogue_gain: [f64; 2],
}

const MAX_STEP: f64 = 16.0;

impl ExposureControl {
    /// The operating point of the frame after `raw`, which was taken at `point`.
    pub(crate) fn next(&self, raw: &Raw, point: OperatingPoint) -> OperatingPoint {
        let Some(level) = self.level(raw) else { return point };
        let ratio = (self.target / level.max(1e-9)).clamp(1.0 / MAX_STEP, MAX_STEP);
        let total = point.exposure_s * point.analogue_gain * pow(ratio, self.damping);
        let exposure_s = (total / self.analogue_gain[0]).clamp(self.exposure_s[0], self.exposure_s[1]);
        let analogue_gain = (total / exposure_s).clamp(self.analogue_gain[0], self.analogue_gain[1]);
        OperatingPoint { exposure_s, analogue_gain }
    }

    /// The level of the percentile, 0 to 1; `None` if there are no pixels.
    fn level(&self, raw: &Raw) -> Option<f64> {
        let linear = raw.linear();
        let mut dn = linear.plane.samples().to_vec();
        let rank = (self.percentile / 100.0 * dn.len() as f64) as usize;
        let rank = rank.min(dn.len().checked_sub(1)?);
        let dn = f64::from(*dn.select_nth_unstable(rank).1);
        Some(((dn - linear.black_level_dn) / (linear.white_level_dn - linear.black_level_dn)).clamp(0.0, 1.0))
    }
}

impl Effect for ExposureControl {
    const NAME: &'static str = "exposure control";
    const KEY: &'static str = "sensor.auto_exposure";

    fn check(&self, facts: &SensorFacts, checks: &mut Checks) {
        let inside = |v: f64| v > 0.0 && v < 1.0;
        let is_percentile = self.percentile > 0.0 && self.percentile < 100.0;
        checks.legal("auto_exposure.percentile", self.percentile, is_percentile, "a percentile between 0 and 100");
        checks.legal("auto_exposure.target", self.target, inside(self.target), "a fraction between 0 and 1");
        checks.fraction_above_0("auto_exposure.damping", self.damping);
        let [low, high] = self.exposure_s;
        checks.positive("auto_exposure.exposure_limits_s", low);
        let around = |[low, high]: [f64; 2], v: f64| low <= v && v <= high && high.is_finite();
        checks.agree("auto_exposure.exposure_limits_s", around(self.exposure_s, facts.exposure_s), || {
            format!(
                "the limits must be in increasing order and contain the exposure of the first frame, {} s",
                facts.exposure_s
            )
        });
        checks.agree(
            "auto_exposure.exposure_limits_s",
            facts.frame_period_s.is_none_or(|period| high <= period),
            || {
                "the longest exposure is longer than \"frame_period_s\": shorten it, or give a longer frame period"
                    .to_owned()
            },
        );
        checks.positive("auto_exposure.gain_limits", self.analogue_gain[0]);
        checks.agree("auto_exposure.gain_limits", around(self.analogue_gain, facts.analogue_gain), || {
            format!(
                "the limits must be in increasing order and contain the gain of the first frame, {}",
                facts.analogue_gain
            )
        });
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        let ([shortest, longest], [smallest, largest]) = (self.exposure_s, self.analogue_gain);
        EffectStatus::Modelled(format!(
            "from frame to frame, {} % of pixels below {} of the range; {shortest} to {longest} s, gain {smallest} to {largest}",
            self.percentile, self.target
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::{FrameAddress, SensorState};
    use crate::frame::tests::{ADDRESS, quiet};
    use crate::sensor::Sensor;
    use etendue_core::Plane;

    fn controlled(damping: f64) -> Sensor {
        let mut p = quiet();
        (p.charge.full_well.capacity_e, p.exposure.exposure_s, p.read_out.bits) = (1e4, 0.01, 14);
        p.exposure.control = Some(ExposureControl {
            percentile: 90.0,
            target: 0.5,
            damping,
            exposure_s: [1e-6, 0.04],
            analogue_gain: [1.0, 8.0],
        });
        Sensor::new(p).expect("legal")
    }

    /// Levels and operating points over frames of a scene with `mean` electrons in the described exposure.
    fn frames(sensor: &Sensor, mean: f32, count: u32) -> Vec<(u32, OperatingPoint)> {
        let mut state = SensorState::default();
        let mut exposures = Vec::new();
        for frame in 0..count {
            let (next, raw) = sensor.step(state, &Plane::filled(8, 8, mean), FrameAddress { frame, ..ADDRESS });
            exposures.push((raw.plane.at(3, 3), raw.operating_point));
            state = next;
        }
        exposures
    }

    #[test]
    fn it_converges_from_dark_and_from_bright() {
        for (mean, damping, count) in [(1500.0, 1.0, 4), (1e7, 1.0, 14), (3000.0, 0.5, 12), (1400.0, 0.5, 14)] {
            let exposures = frames(&controlled(damping), mean, count);
            let (dn, _) = *exposures.last().expect("frames");
            // Half of the well, to a rounding of the measured level.
            assert!((f64::from(dn) / 5000.0 - 1.0).abs() < 0.02, "{mean}: {exposures:?}");
        }
    }

    #[test]
    fn time_comes_before_gain_and_limits_hold() {
        let (_, point) = *frames(&controlled(1.0), 500.0, 6).last().expect("frames");
        assert_eq!(point.exposure_s, 0.04);
        // 2000 e⁻ at the longest time; half of the ADC's 16 383 DN is half of white if the gain exceeds 1.6.
        assert!((point.analogue_gain - 16_383.0 / 4000.0).abs() < 0.01, "{point:?}");
        let (_, point) = *frames(&controlled(1.0), 1.0, 8).last().expect("frames");
        assert_eq!((point.exposure_s, point.analogue_gain), (0.04, 8.0));
    }

    #[test]
    fn a_dark_scene_asks_for_all_there_is() {
        let (_, point) = *frames(&controlled(1.0), 0.0, 4).last().expect("frames");
        assert_eq!((point.exposure_s, point.analogue_gain), (0.04, 8.0));
    }
}
