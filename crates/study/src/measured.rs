//! Results of pilots of one configuration: noise and time of a sample, and distance of its mean from the exact one.

use crate::configuration::Configuration;
use crate::error::{ErrorMetrics, Estimate};
use crate::pilot::Pilot;
use crate::pixels::SampledPixels;
use etendue_core::maths::f64::{hypot, ln, pow};
use etendue_stats::{Moments, upper_median};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// A pilot run and its samples per pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampledPilot<'a> {
    /// Samples per pixel.
    pub(crate) spp: u32,
    /// Its planes and times.
    pub(crate) pilot: &'a Pilot,
}

/// A mean square that decreases with a power of the samples of a replicate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PowerLaw {
    /// Number of samples at which `value` holds.
    pub samples: f64,
    /// Mean square.
    pub value: Estimate,
    /// Exponent: 1 for independent samples, more for stratified ones; with its uncertainty.
    pub exponent: Estimate,
}

/// Plausible exponents: independent samples have 1, stratified samples of smooth light more; values below 1 occur only by chance.
const EXPONENTS: [f64; 2] = [0.9, 1.6];

impl PowerLaw {
    /// Power law through two numbers of samples, the second the larger; an uncertain exponent is shrunk towards 1.
    fn from_two_pilots(few: u32, estimate_few: Estimate, many: u32, estimate_many: Estimate) -> Self {
        let (few, many) = (f64::from(few), f64::from(many));
        let span = ln(many / few);
        let fitted = ln(estimate_few.value / estimate_many.value) / span;
        let of = |e: Estimate| e.uncertainty / e.value;
        let uncertainty = hypot(of(estimate_few), of(estimate_many)) / span;
        // Typical deviation of scenes' exponents from 1.
        const SCATTER: f64 = 0.15;
        let weight = SCATTER * SCATTER / (SCATTER * SCATTER + uncertainty * uncertainty);
        let exponent = 1.0 + weight * (fitted - 1.0);
        let known = exponent.is_finite() && estimate_many.value > 0.0;
        let exponent = match known {
            true => exponent.clamp(EXPONENTS[0], EXPONENTS[1]),
            false => 1.0,
        };
        let uncertainty = SCATTER * if known { (1.0 - weight).sqrt() } else { 1.0 };
        Self { samples: many, value: estimate_many, exponent: Estimate { value: exponent, uncertainty } }
    }

    /// Mean square of one replicate of `samples` samples.
    #[must_use]
    pub fn at(&self, samples: f64) -> Estimate {
        let ratio = samples / self.samples;
        let mean = self.value.times(pow(ratio, -self.exponent.value));
        let by_exponent = mean.value * ln(ratio).abs() * self.exponent.uncertainty;
        Estimate { uncertainty: hypot(mean.uncertainty, by_exponent), ..mean }
    }
}

/// Bias: mean square of the difference of means, in each metric.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bias {
    /// Configuration that it is compared with.
    pub against: Configuration,
    /// Mean squares; below 0 only within their uncertainty.
    pub squares: ErrorMetrics<Estimate>,
}

/// Role of a configuration in the study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Simulates all light; the others are compared with it.
    Exact,
    /// Omits some light: its bias is reported.
    Approximation,
    /// The unchanged job.
    Stated,
    /// An unbiased alternative to a choice of the job. It has the bias of the configuration that it is derived from; any other measured difference is chance.
    Choice,
}

/// Measurements of one configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConfigurationMeasurement {
    #[serde(rename = "way")]
    pub configuration: Configuration,
    /// Its role in the study.
    pub role: Role,
    /// Time of reading files, compiling the scene and building its acceleration structures, s.
    pub load_s: f64,
    /// Time of a frame's light excluding its samples, s.
    pub frame_s: f64,
    /// Time of one sample of every pixel of the frame, s.
    pub sample_s: Estimate,
    /// Variances of one replicate.
    pub variance: ErrorMetrics<PowerLaw>,
    /// Bias relative to the next more exact configuration; `None` for the exact form itself.
    pub bias: Option<Bias>,
    /// Upper bound of the mean square of all that it omits from the exact form, 0 or more: measured values below 0 are chance.
    pub bias_squares: ErrorMetrics<Estimate>,
}

/// Times of a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Times {
    pub(crate) frame_s: f64,
    pub(crate) sample_s: Estimate,
}

impl Times {
    /// Times from pilots of few and of many samples of a fraction of the frame's tiles: samples use all threads, the rest a single one.
    pub(crate) fn new(few: SampledPilot<'_>, many: SampledPilot<'_>, tile_fraction: f64, threads: usize) -> Self {
        let median = |seconds: &[f64]| upper_median(seconds.iter().copied()).unwrap_or(f64::NAN);
        let (SampledPilot { spp: few, pilot: estimate_few }, SampledPilot { spp: many, pilot: estimate_many }) =
            (few, many);
        let (short_s, long_s) = (median(&estimate_few.processor_s), median(&estimate_many.processor_s));
        let step = f64::from(many - few);
        let slope_s = ((long_s - short_s) / step).max(1e-12);
        let frame_s = (short_s - slope_s * f64::from(few)).clamp(0.0, short_s);
        // Standard deviation of the median of n normal numbers: √(π/2) times that of their mean.
        let spread = |seconds: &[f64]| {
            let variance = Moments::from_values(seconds.iter().copied()).variance().unwrap_or(f64::NAN);
            (FRAC_PI_2 * variance / seconds.len() as f64).sqrt()
        };
        let uncertainty = hypot(spread(&estimate_few.processor_s), spread(&estimate_many.processor_s)) / step;
        Self {
            frame_s,
            sample_s: Estimate { value: slope_s, uncertainty }.times(1.0 / (tile_fraction * threads as f64)),
        }
    }
}

/// Variances from pilots of few and of many samples.
pub(crate) fn variance(
    pixels: &SampledPixels,
    few: SampledPilot<'_>,
    many: SampledPilot<'_>,
) -> ErrorMetrics<PowerLaw> {
    let (low, high) = (pixels.variance(&few.pilot.planes), pixels.variance(&many.pilot.planes));
    low.with(&high, |a, b| PowerLaw::from_two_pilots(few.spp, *a, many.spp, *b))
}

/// Mean squares of the differences between planes of equal seeds.
pub(crate) fn bias(pixels: &SampledPixels, own: &Pilot, exact: &Pilot) -> ErrorMetrics<Estimate> {
    let difference = |(a, b): (&Vec<f32>, &Vec<f32>)| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f32>>();
    let differences: Vec<_> = own.planes.iter().zip(&exact.planes).map(difference).collect();
    pixels.squared_mean(&differences)
}

impl ConfigurationMeasurement {
    /// Mean square error of `spp` samples in `replicates` replicates.
    #[must_use]
    pub fn error(&self, spp: f64, replicates: f64) -> ErrorMetrics<Estimate> {
        let variance = self.variance.map(|law| law.at(spp / replicates).times(1.0 / replicates));
        variance.with(&self.bias_squares, |variance, bias| variance.plus(*bias))
    }

    /// Time of the whole run, s, including that of a frame outside its light.
    #[must_use]
    pub fn seconds(&self, spp: f64, rest_s: f64) -> Estimate {
        let fixed = Estimate { value: self.load_s + self.frame_s + rest_s, uncertainty: 0.0 };
        self.sample_s.times(spp).plus(fixed)
    }
}

/// Upper bound of two omissions together (Minkowski): both are missing light, so that they seldom cancel.
pub(crate) fn in_series(a: &Estimate, b: &Estimate) -> Estimate {
    let (first, second) = (a.value.max(0.0).sqrt(), b.value.max(0.0).sqrt());
    if first * second == 0.0 {
        return a.plus(*b);
    }
    let uncertainty = hypot(a.uncertainty * (1.0 + second / first), b.uncertainty * (1.0 + first / second));
    Estimate { value: (first + second) * (first + second), uncertainty }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_goes_through_what_is_well_known_and_leans_to_1_else() {
        let known = |value: f64| Estimate { value, uncertainty: 1e-6 * value };
        let law = PowerLaw::from_two_pilots(2, known(8.0), 8, known(1.0));
        assert!((law.exponent.value - 1.5).abs() < 1e-6 && (law.at(32.0).value - 0.125).abs() < 1e-6);
        let vague = |value: f64| Estimate { value, uncertainty: value };
        let law = PowerLaw::from_two_pilots(2, vague(8.0), 8, vague(1.0));
        assert!((law.exponent.value - 1.0).abs() < 0.03, "{law:?}");
        let none = PowerLaw::from_two_pilots(2, known(0.0), 8, known(0.0));
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
        let times = Times::new(few, many, 0.1, 2);
        assert!((times.sample_s.value - 0.5).abs() < 1e-9 && (times.frame_s - 0.31).abs() < 1e-9, "{times:?}");
    }
}
