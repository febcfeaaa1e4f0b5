//! What pilots tell of one way to render: how noisy a sample is, how long it takes, how far its mean lies from the exact one.

use crate::error::{Currencies, Estimate};
use crate::pilot::Pilot;
use crate::pixels::Pixels;
use crate::way::WayToRender;
use etendue_core::maths::f64::{hypot, ln, pow};
use etendue_stats::{Moments, upper_median};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// A pilot run and its samples per pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampledPilot<'a> {
    /// Samples per pixel.
    pub(crate) spp: u32,
    /// What it rendered.
    pub(crate) pilot: &'a Pilot,
}

/// A mean square that falls with a power of the samples of a replicate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PowerLaw {
    /// At so many samples.
    pub samples: f64,
    /// The mean square.
    pub value: Estimate,
    /// The power: 1 of independent samples, more of stratified ones; with its uncertainty.
    pub exponent: Estimate,
}

/// Exponents that are believed: independent samples have 1, stratified ones of smooth light more; below 1 lies none, but for luck.
const EXPONENTS: [f64; 2] = [0.9, 1.6];

impl PowerLaw {
    /// Through two numbers of samples, the second the larger; an exponent that is badly known is drawn towards 1.
    fn through(few: u32, at_few: Estimate, many: u32, at_many: Estimate) -> Self {
        let (few, many) = (f64::from(few), f64::from(many));
        let span = ln(many / few);
        let found = ln(at_few.value / at_many.value) / span;
        let of = |e: Estimate| e.uncertainty / e.value;
        let uncertainty = hypot(of(at_few), of(at_many)) / span;
        // By how much exponents of scenes differ from 1.
        const SCATTER: f64 = 0.15;
        let weight = SCATTER * SCATTER / (SCATTER * SCATTER + uncertainty * uncertainty);
        let exponent = 1.0 + weight * (found - 1.0);
        let known = exponent.is_finite() && at_many.value > 0.0;
        let exponent = match known {
            true => exponent.clamp(EXPONENTS[0], EXPONENTS[1]),
            false => 1.0,
        };
        let uncertainty = SCATTER * if known { (1.0 - weight).sqrt() } else { 1.0 };
        Self { samples: many, value: at_many, exponent: Estimate { value: exponent, uncertainty } }
    }

    /// The mean square of one replicate of so many samples.
    #[must_use]
    pub fn at(&self, samples: f64) -> Estimate {
        let ratio = samples / self.samples;
        let mean = self.value.times(pow(ratio, -self.exponent.value));
        let by_exponent = mean.value * ln(ratio).abs() * self.exponent.uncertainty;
        Estimate { uncertainty: hypot(mean.uncertainty, by_exponent), ..mean }
    }
}

/// What a way leaves out: the mean square of the difference of means, in each currency.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bias {
    /// Against which way.
    pub against: WayToRender,
    /// Mean squares; below 0 only by their uncertainty.
    pub squares: Currencies<Estimate>,
}

/// Why a way was looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// It follows all light; the others are compared with it.
    Exact,
    /// It leaves something out: its bias is told.
    Approximation,
    /// The job as it stands.
    Stated,
    /// A choice that changes no mean, made otherwise than the job makes it: it has the bias of the way that it was made from, and what is found beside that is chance.
    Choice,
}

/// What is known of one way to render.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Which.
    pub way: WayToRender,
    /// Why it was looked at.
    pub role: Role,
    /// Reading files, compiling the scene and building its trees, s.
    pub load_s: f64,
    /// What the light of a frame takes beside its samples, s.
    pub frame_s: f64,
    /// One sample of every pixel of the frame, s.
    pub sample_s: Estimate,
    /// Variances of one replicate.
    pub variance: Currencies<PowerLaw>,
    /// Found against the next more exact way; `None` of the exact form itself.
    pub bias: Option<Bias>,
    /// The mean square of everything that it leaves out of the exact form, at most, and 0 or more: what is found below 0 is chance.
    pub bias_squares: Currencies<Estimate>,
}

/// Times of a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Times {
    pub(crate) frame_s: f64,
    pub(crate) sample_s: Estimate,
}

impl Times {
    /// By pilots of few and of many samples of a share of the frame's tiles: samples are all threads' work, the rest one's.
    pub(crate) fn of(few: SampledPilot<'_>, many: SampledPilot<'_>, share: f64, threads: usize) -> Self {
        let median = |seconds: &[f64]| upper_median(seconds.iter().copied()).unwrap_or(f64::NAN);
        let (SampledPilot { spp: few, pilot: at_few }, SampledPilot { spp: many, pilot: at_many }) = (few, many);
        let (short_s, long_s) = (median(&at_few.processor_s), median(&at_many.processor_s));
        let step = f64::from(many - few);
        let slope_s = ((long_s - short_s) / step).max(1e-12);
        let frame_s = (short_s - slope_s * f64::from(few)).clamp(0.0, short_s);
        // Of a median of n normal numbers: √(π/2) of the deviation of their mean.
        let spread = |seconds: &[f64]| {
            let variance = Moments::of(seconds.iter().copied()).variance().unwrap_or(f64::NAN);
            (FRAC_PI_2 * variance / seconds.len() as f64).sqrt()
        };
        let uncertainty = hypot(spread(&at_few.processor_s), spread(&at_many.processor_s)) / step;
        Self { frame_s, sample_s: Estimate { value: slope_s, uncertainty }.times(1.0 / (share * threads as f64)) }
    }
}

/// Variances by pilots of few and of many samples.
pub(crate) fn variance(pixels: &Pixels, few: SampledPilot<'_>, many: SampledPilot<'_>) -> Currencies<PowerLaw> {
    let (low, high) = (pixels.variance(&few.pilot.planes), pixels.variance(&many.pilot.planes));
    low.with(&high, |a, b| PowerLaw::through(few.spp, *a, many.spp, *b))
}

/// Mean squares of what planes of equal seeds differ by.
pub(crate) fn bias(pixels: &Pixels, own: &Pilot, exact: &Pilot) -> Currencies<Estimate> {
    let difference = |(a, b): (&Vec<f32>, &Vec<f32>)| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f32>>();
    let differences: Vec<_> = own.planes.iter().zip(&exact.planes).map(difference).collect();
    pixels.squared_mean(&differences)
}

impl Measured {
    /// The mean square of the error of so many samples in so many replicates.
    #[must_use]
    pub fn error(&self, spp: f64, replicates: f64) -> Currencies<Estimate> {
        let variance = self.variance.map(|law| law.at(spp / replicates).times(1.0 / replicates));
        variance.with(&self.bias_squares, |variance, bias| variance.plus(*bias))
    }

    /// The whole run, s, with what a frame takes beside its light.
    #[must_use]
    pub fn seconds(&self, spp: f64, rest_s: f64) -> Estimate {
        let fixed = Estimate { value: self.load_s + self.frame_s + rest_s, uncertainty: 0.0 };
        self.sample_s.times(spp).plus(fixed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_goes_through_what_is_well_known_and_leans_to_1_else() {
        let known = |value: f64| Estimate { value, uncertainty: 1e-6 * value };
        let law = PowerLaw::through(2, known(8.0), 8, known(1.0));
        assert!((law.exponent.value - 1.5).abs() < 1e-6 && (law.at(32.0).value - 0.125).abs() < 1e-6);
        let vague = |value: f64| Estimate { value, uncertainty: value };
        let law = PowerLaw::through(2, vague(8.0), 8, vague(1.0));
        assert!((law.exponent.value - 1.0).abs() < 0.03, "{law:?}");
        let none = PowerLaw::through(2, known(0.0), 8, known(0.0));
        assert!(none.exponent.value == 1.0 && none.at(100.0).value == 0.0);
    }

    #[test]
    fn times_are_a_frame_and_its_samples() {
        let pilot = |seconds: [f64; 3]| Pilot {
            pixels: Vec::new(),
            planes: Vec::new(),
            processor_s: seconds.to_vec(),
            clock_s: 0.0,
        };
        let (few, many) = (pilot([0.51, 0.9, 0.51]), pilot([1.12, 1.11, 1.11]));
        let (few, many) = (SampledPilot { spp: 2, pilot: &few }, SampledPilot { spp: 8, pilot: &many });
        let times = Times::of(few, many, 0.1, 2);
        assert!((times.sample_s.value - 0.5).abs() < 1e-9 && (times.frame_s - 0.31).abs() < 1e-9, "{times:?}");
    }
}
