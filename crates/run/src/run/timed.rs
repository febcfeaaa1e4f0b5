//! Passes of a run of a given time: as many as the time allows.
//!
//! The films of all cameras and frames receive the same passes in turn, so that a list of these passes reproduces the same bits; the films are held in memory
//! together. A pilot, which renders a subset of the pixels and discards their light, measures the rate first. Time counts from its first sample. A round (one
//! pass of all films) that exceeds the time by far is discarded.

use super::pace::{PassSchedule, SampleRate};
use crate::film_file::StoredPasses;
use etendue_core::maths::least_common_multiple;
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{MAX_PASSES, NumberedPass, PARTS, Pass, Passes};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

/// A round is discarded at this multiple of the time.
const DISCARD_RATIO: f64 = 1.05;

/// Minimum fraction of the time for the pilot, and its maximum part of the pixels.
const PILOT_FRACTION: f64 = 0.01;
const MAX_PILOT_PARTS: u32 = PARTS / 4;

/// A point in a run: elapsed time, and the part of it spent on samples, s.
#[derive(Clone, Copy, Debug)]
pub(super) struct TimePoint {
    now_s: f64,
    light_s: f64,
}

/// The current pass of all films.
#[derive(Debug)]
struct Round {
    /// The passes, including that of the round.
    passes: Passes,
    begin: TimePoint,
}

/// Passes of a run of a given time.
pub(super) struct TimedPasses<'a> {
    /// The plan as compiled, without passes.
    pub(super) compiled: Arc<Plan>,
    total_s: f64,
    observer: &'a dyn Observer,
    pub(super) watch: RenderClock<'a>,
    /// Completed passes.
    passes: Passes,
    round: Option<Round>,
    /// Replicates of each pass: those of an interrupted run, or as many as the time allows; `None` if the job states them.
    replicates: Option<u32>,
    /// Part of the pixels for the next pilot, in 256ths.
    pilot_part: u32,
    /// Rate of samples; `None` until a pilot has taken long enough.
    rate: Option<SampleRate>,
    has_warned: bool,
    /// True once the time is up.
    pub(super) is_over: bool,
}

impl<'a> TimedPasses<'a> {
    /// Returns no passes yet, for a run of `total_s`.
    ///
    /// # Errors
    /// The observer has no clock.
    pub(super) fn new(compiled: &Arc<Plan>, total_s: f64, observer: &'a dyn Observer) -> Result<Self, Error> {
        Ok(Self {
            compiled: Arc::clone(compiled),
            total_s,
            observer,
            watch: RenderClock::new(observer)?,
            passes: Passes::default(),
            round: None,
            replicates: None,
            pilot_part: 1,
            rate: None,
            has_warned: false,
            is_over: false,
        })
    }

    /// Continues from the passes of an interrupted run, given one of its films: those of the film with most passes.
    pub(super) fn resume(&mut self, stored: &StoredPasses) {
        if stored.passes.list().len() >= self.passes.list().len() {
            self.passes = stored.passes.clone();
            self.replicates = Some(stored.replicates);
            self.watch.before_s = stored.elapsed_s;
        }
    }

    /// Returns true if the rate is known.
    pub(super) fn has_rate(&self) -> bool {
        self.rate.is_some()
    }

    /// Passes that all films are to receive: the completed ones, and that of the current round.
    pub(super) fn requested_passes(&self) -> &Passes {
        self.round.as_ref().map_or(&self.passes, |round| &round.passes)
    }

    pub(super) fn completed_passes(&self) -> &Passes {
        &self.passes
    }

    /// Returns true during a round.
    pub(super) fn is_in_round(&self) -> bool {
        self.round.is_some()
    }

    /// Returns the plan with the completed passes.
    pub(super) fn plan_of_done(&self, plan: &Plan) -> Plan {
        plan.with_passes(&self.passes, self.replicates)
    }

    /// Returns the next pilot.
    pub(super) fn pilot(&self, plan: &Plan) -> NumberedPass {
        NumberedPass { pass: Pass { samples: min_samples(plan), part: self.pilot_part }, ..NumberedPass::only(0) }
    }

    /// Ends a pilot that began at `begin`. Returns the plan of the run, with its replicates, or `None` if another pilot, four times as large, is needed.
    pub(super) fn end_pilot(&mut self, plan: &Plan, pilot: NumberedPass, begin: TimePoint) -> Option<Plan> {
        let rate = self.watch.rate(pilot.pass, begin);
        let is_long = rate.sample_s * pilot.pass.number() >= PILOT_FRACTION * self.total_s;
        if !is_long && pilot.pass.part < MAX_PILOT_PARTS {
            self.pilot_part *= 4;
            return None;
        }
        self.rate = Some(rate);
        self.replicates = match (plan.open_replicates(), self.replicates) {
            (None, _) => None,
            (Some(_), Some(stored)) => Some(stored),
            (Some(max_replicates), None) => Some(self.affordable_replicates(plan, max_replicates, rate.sample_s)),
        };
        Some(self.plan_of_done(plan))
    }

    /// Returns `most` replicates, or fewer if the time does not allow so many.
    fn affordable_replicates(&self, plan: &Plan, max_replicates: u32, sample_s: f64) -> u32 {
        let min_replicates = if plan.cameras.iter().any(|camera| camera.products.variance) { 2 } else { 1 };
        let choice: Vec<u32> = (min_replicates..=max_replicates)
            .rev()
            .filter(|replicates| max_replicates.is_multiple_of(*replicates))
            .collect();
        let replicates = self.pace(plan).replicates(sample_s, &choice);
        if replicates < max_replicates {
            let note = format!(
                "`time_s` {} does not allow passes of {max_replicates} replicates; {replicates} are used",
                self.total_s
            );
            self.observer.message(Message::Note(&note));
        }
        replicates
    }

    /// Starts the next round. Returns false if there is none.
    pub(super) fn begin_round(&mut self, plan: &Plan) -> bool {
        let Some(rate) = self.rate else { return false };
        let schedule = self.pace(plan);
        if !self.has_warned {
            self.has_warned = true;
            self.warn(schedule, rate);
        }
        if self.passes.list().len() >= MAX_PASSES {
            return false;
        }
        let Some(next) = schedule.next(self.watch.elapsed_s(), rate, self.passes.spp()) else { return false };
        let mut passes = self.passes.clone();
        passes.push(next);
        let may_be_discarded = !self.passes.list().is_empty();
        let begin = self.watch.time_point();
        self.watch.limit_s = may_be_discarded.then_some(DISCARD_RATIO * self.total_s);
        self.round = Some(Round { passes, begin });
        true
    }

    /// Ends the round: all films have its pass.
    pub(super) fn end_round(&mut self) {
        let Some(Round { passes, begin }) = self.round.take() else { return };
        self.rate = passes.list().last().map(|last| self.watch.rate(*last, begin));
        self.passes = passes;
    }

    /// Discards the round.
    pub(super) fn give_up_round(&mut self) {
        self.round = None;
    }

    /// Adds time, s, to that of a round outside its samples.
    pub(super) fn add_overhead(&mut self, time_s: f64) {
        if let Some(rate) = &mut self.rate {
            rate.overhead_s += time_s;
        }
    }

    fn pace(&self, plan: &Plan) -> PassSchedule {
        let min_pass_spp = min_samples(plan);
        PassSchedule {
            total_s: self.total_s,
            min_pass_spp,
            has_parts: plan.replicates().all(|replicates| replicates == min_pass_spp),
        }
    }

    fn warn(&self, schedule: PassSchedule, rate: SampleRate) {
        let needed_s = rate.sample_s * f64::from(schedule.min_pass_spp);
        if needed_s > DISCARD_RATIO * self.total_s {
            let samples = if schedule.min_pass_spp == 1 {
                "one sample".to_owned()
            } else {
                format!("{} samples", schedule.min_pass_spp)
            };
            self.observer.message(Message::Warning(&format!(
                "rendering {samples} per pixel, the minimum for a result, takes about {needed_s:.0} s, more than \
                 `time_s` {}; give more time, smaller images, or fewer frames, cameras or replicates",
                self.total_s
            )));
        }
    }

    /// Reports the elapsed time to the observer, and the keys that reproduce the same bytes.
    pub(super) fn report(&self, plan: &Plan) {
        let mut replicates: Vec<u32> = plan.replicates().collect();
        replicates.dedup();
        let replicates = match replicates[..] {
            [one] => format!("`set` render.replicates={one} "),
            _ => String::new(),
        };
        self.observer.message(Message::Note(&format!(
            "{:.2} s of rendering (`time_s` {}): {} samples per pixel; {replicates}`set` \"render.passes={}\" gives the same bytes",
            self.watch.elapsed_s(),
            self.total_s,
            self.passes.mean_spp(),
            self.passes.text()
        )));
    }
}

/// Smallest sample count that all cameras can share.
fn min_samples(plan: &Plan) -> u32 {
    plan.replicates().fold(1, least_common_multiple)
}

/// Clock of the light's rendering.
pub(super) struct RenderClock<'a> {
    observer: &'a dyn Observer,
    /// Time taken by an interrupted run, s.
    before_s: f64,
    /// Start of the first sample.
    start_s: OnceLock<f64>,
    /// Start of the current pass, and the time of samples before it, s.
    pass: Mutex<(f64, f64)>,
    /// Time at which a pass is discarded, s.
    limit_s: Option<f64>,
    /// True once a pass was discarded.
    is_over: AtomicBool,
}

impl<'a> RenderClock<'a> {
    fn new(observer: &'a dyn Observer) -> Result<Self, Error> {
        if observer.now_s().is_none() {
            return Err(Error::coded(
                ErrorCode::InvalidArgument,
                "a time is requested, but the caller has no clock; give samples instead",
            ));
        }
        Ok(Self {
            observer,
            before_s: 0.0,
            start_s: OnceLock::new(),
            pass: Mutex::default(),
            limit_s: None,
            is_over: AtomicBool::new(false),
        })
    }

    fn now_s(&self) -> f64 {
        self.observer.now_s().unwrap_or_default()
    }

    pub(super) fn time_point(&self) -> TimePoint {
        TimePoint { now_s: self.now_s(), light_s: self.light_s() }
    }

    /// Time since the first sample, s, including that of an interrupted run.
    pub(super) fn elapsed_s(&self) -> f64 {
        self.before_s + self.start_s.get().map_or(0.0, |start_s| self.now_s() - start_s)
    }

    /// Time spent on samples, s.
    fn light_s(&self) -> f64 {
        self.pass.lock().expect("no clock panics").1
    }

    pub(super) fn begin_pass(&self) {
        let now_s = self.now_s();
        self.start_s.get_or_init(|| now_s);
        self.pass.lock().expect("no clock panics").0 = now_s;
    }

    pub(super) fn end_pass(&self) {
        let mut pass = self.pass.lock().expect("no clock panics");
        pass.1 += self.now_s() - pass.0;
    }

    /// Rate of a pass of all films that began at `begin`.
    fn rate(&self, pass: Pass, begin: TimePoint) -> SampleRate {
        let light_s = self.light_s() - begin.light_s;
        let overhead_s = (self.now_s() - begin.now_s - light_s).max(0.0);
        SampleRate { sample_s: (light_s / pass.number()).max(f64::MIN_POSITIVE), overhead_s }
    }

    /// Returns true if the current pass must be discarded.
    pub(super) fn is_pass_discarded(&self) -> bool {
        let is_over = self.limit_s.is_some_and(|limit_s| self.elapsed_s() > limit_s);
        if is_over {
            self.is_over.store(true, Ordering::Relaxed);
        }
        is_over
    }

    /// Returns true if a pass was discarded.
    pub(super) fn was_pass_discarded(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}
