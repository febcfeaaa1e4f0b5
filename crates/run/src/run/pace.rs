//! Size of the next pass in a run of a given time.
//!
//! The sample rate is that of the last pass, because it may change with other work on the machine or a lower clock. Except for the last passes, no pass is
//! estimated to take more than [`MAX_FRACTION`] of the remaining time. No pass is larger than all passes before it, so that the image refines evenly and a
//! wrong rate is noticed early. When [`MAX_LAST_FRACTION`] of the total time is left, a pass takes all of it. Passes are whole unless the smallest one, one
//! sample per pixel in each replicate, is too large: then a pass takes a subset of the pixels.

use etendue_pipeline::plan::{PARTS, Pass};

/// Maximum fraction of the remaining time for a pass.
const MAX_FRACTION: f64 = 0.6;
/// Maximum fraction of the total time that one pass may use up.
const MAX_LAST_FRACTION: f64 = 0.12;
/// Fraction of the total time that is too short for a pass.
const MIN_PASS_FRACTION: f64 = 0.01;

/// Maximum total samples per pixel of a job's passes.
const MAX_SPP: u32 = 1 << 20;

/// Rate of sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SampleRate {
    /// Time of one sample of every pixel of all films, s.
    pub(crate) sample_s: f64,
    /// Time of a pass without its samples, s.
    pub(crate) overhead_s: f64,
}

/// Schedule of passes over a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PassSchedule {
    /// Total time, s.
    pub(crate) total_s: f64,
    /// Samples of the smallest whole pass; all passes are multiples of it.
    pub(crate) min_pass_spp: u32,
    /// True if a pass may take a subset of the pixels.
    pub(crate) has_parts: bool,
}

impl PassSchedule {
    /// Returns the next pass after passes of `done_spp` samples of every pixel; `None` if the time is up.
    pub(crate) fn next(&self, elapsed_s: f64, rate: SampleRate, done_spp: u32) -> Option<Pass> {
        let room_s = self.total_s - elapsed_s - rate.overhead_s;
        if done_spp == 0 {
            return Some(Pass::all_pixels(self.min_pass_spp));
        }
        if room_s < MIN_PASS_FRACTION * self.total_s {
            return None;
        }
        let is_last = self.total_s - elapsed_s <= MAX_LAST_FRACTION * self.total_s;
        let aim_s = if is_last { room_s } else { MAX_FRACTION * room_s };
        let min_s = rate.sample_s * f64::from(self.min_pass_spp);
        let allowed = MAX_SPP.saturating_sub(done_spp) / self.min_pass_spp;
        if allowed == 0 {
            return None;
        }
        let times = (aim_s / min_s).min(f64::from(done_spp / self.min_pass_spp)).min(f64::from(allowed)).floor();
        if times >= 1.0 {
            return Some(Pass::all_pixels(self.min_pass_spp * times as u32));
        }
        if min_s <= room_s {
            return Some(Pass::all_pixels(self.min_pass_spp));
        }
        let part = (aim_s / min_s * f64::from(PARTS)).floor() as u32;
        (self.has_parts && part > 0).then_some(Pass { samples: self.min_pass_spp, part })
    }

    /// Returns the largest number of replicates in `choice` that leaves time for three passes; the smallest if none does.
    pub(crate) fn replicates(&self, sample_s: f64, choice: &[u32]) -> u32 {
        let fits = |replicates: &&u32| sample_s * f64::from(**replicates) <= self.total_s / 3.0;
        choice.iter().find(fits).or(choice.last()).copied().unwrap_or(self.min_pass_spp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulates a run on a machine of the given speed over time; returns its time and its passes.
    fn run(schedule: PassSchedule, overhead_s: f64, sample_s: f64, speed: impl Fn(f64) -> f64) -> (f64, Vec<Pass>) {
        let (mut now_s, mut spp, mut passes) = (0.0, 0, Vec::new());
        let mut rate = SampleRate { sample_s: sample_s / speed(0.0), overhead_s };
        while let Some(pass) = schedule.next(now_s, rate, spp) {
            let mut left = pass.number() * sample_s;
            let begin_s = now_s;
            while left > 0.0 {
                let step_s = (left / speed(now_s)).min(0.01);
                (left, now_s) = (left - step_s * speed(now_s), now_s + step_s);
            }
            rate.sample_s = (now_s - begin_s) / pass.number();
            now_s += overhead_s;
            spp += if pass.is_whole() { pass.samples } else { 0 };
            passes.push(pass);
        }
        (now_s, passes)
    }

    const SCHEDULE: PassSchedule = PassSchedule { total_s: 10.0, min_pass_spp: 4, has_parts: true };

    #[test]
    fn a_steady_machine_keeps_the_time_at_every_rate() {
        for sample_s in [1e-4, 0.003, 0.02, 0.1, 0.3, 0.5, 0.83, 1.4, 2.2] {
            for overhead_s in [0.0, 0.05, 0.2] {
                let (took_s, passes) = run(SCHEDULE, overhead_s, sample_s, |_| 1.0);
                assert!((took_s / 10.0 - 1.0).abs() < 0.03, "{sample_s} {overhead_s}: {took_s} s, {passes:?}");
                assert!(passes.len() <= 32, "{} passes", passes.len());
            }
        }
    }

    #[test]
    fn a_machine_whose_speed_changes_keeps_it_within_a_tenth() {
        for sample_s in [1e-3, 0.02, 0.2] {
            let slowed = |at_s: f64| move |now_s: f64| if now_s < at_s { 1.0 } else { 0.6 };
            for at_s in [1.0, 3.0, 5.0, 7.0, 9.0, 9.5] {
                let (took_s, _) = run(SCHEDULE, 0.05, sample_s, slowed(at_s));
                assert!((took_s / 10.0 - 1.0).abs() < 0.1, "slower from {at_s} s: {took_s} s");
                let (took_s, _) = run(SCHEDULE, 0.05, sample_s, |now_s| 1.0 / slowed(at_s)(now_s));
                assert!((took_s / 10.0 - 1.0).abs() < 0.1, "faster from {at_s} s: {took_s} s");
            }
            let (took_s, _) = run(SCHEDULE, 0.05, sample_s, |now_s| 1.0 + 0.5 * f64::from((2.0 * now_s) as u32 % 2));
            assert!((took_s / 10.0 - 1.0).abs() < 0.1, "to and fro: {took_s} s");
        }
    }

    #[test]
    fn slow_scenes_have_fewer_replicates_and_parts() {
        let choice = [4, 2, 1];
        let replicates = |sample_s| SCHEDULE.replicates(sample_s, &choice);
        assert_eq!([0.5, 1.2, 2.0, 9.0, 50.0].map(replicates), [4, 2, 1, 1, 1]);
        let (took_s, passes) = run(PassSchedule { min_pass_spp: 1, ..SCHEDULE }, 0.0, 7.0, |_| 1.0);
        assert!((took_s - 10.0).abs() < 0.5, "{took_s}");
        assert!(passes[0].is_whole() && passes[1..].iter().all(|pass| !pass.is_whole()), "{passes:?}");
        assert_eq!(run(PassSchedule { min_pass_spp: 1, ..SCHEDULE }, 0.0, 25.0, |_| 1.0).1, [Pass::all_pixels(1)]);
    }
}
