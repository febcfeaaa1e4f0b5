//! Pulses as integrated by exposures: a trapezoid over time.

use core::f64::consts::PI;

use etendue_core::waveform::{Pulses, Waveform};
use etendue_core::{TimeInterval, maths::f64::sin};

use super::time_series::{FourierFit, TimeSeries, explained};
use crate::Estimate;
use crate::fit::{Fit, Problem, fit};

/// Pulsed light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseLight {
    /// Duty cycle: fraction of the period that a pulse lasts.
    pub duty: Estimate,
    /// Mean light of the pulses relative to the total, including constant light.
    pub pulsed_fraction: Estimate,
    /// (max − min)/(max + min) as integrated by the exposures.
    pub modulation: Estimate,
}

#[derive(Clone, Copy)]
pub(super) struct FittedPulses {
    pub(super) light: PulseLight,
    pub(super) frequency_hz: Estimate,
    /// Sum of squared residuals.
    pub(super) squares: f64,
}

/// Number of initial duty cycles.
const DUTIES: u32 = 39;

/// Indices of the parameters: level, pulses over level, frequency, phase of a pulse's middle (periods), duty cycle, then shading.
const PULSED: usize = 1;
const FREQUENCY: usize = 2;
const PHASE: usize = 3;
const DUTY: usize = 4;
const SHADING: usize = 5;

struct PulseProblem<'a> {
    series: &'a TimeSeries,
    values: Vec<f64>,
    times: Vec<(f64, f64)>,
    shading: Vec<Vec<f64>>,
    exposure_s: f64,
    start: Vec<f64>,
}

/// Allowed excess of the pulse fraction above 1 before the duty cycle is fitted.
const PULSED_SLACK: f64 = 0.1;

/// Fits pulses, starting with the frequency and phase of a Fourier series; `None` if none fit, or if two different solutions fit
/// equally well.
pub(super) fn fitted(series: &TimeSeries, fourier: &FourierFit, exposure_s: f64) -> Option<FittedPulses> {
    let frequency_hz = fourier.frequency_hz.value;
    let x = PI * frequency_hz * exposure_s;
    // An exposure longer than a period inverts the fundamental.
    let turned = if sin(x) < 0.0 { 0.5 } else { 0.0 };
    let middle = fourier.peak_periods() + 0.5 * frequency_hz * exposure_s + turned;
    let shading = series.level_columns(fourier.shading).split_off(1);
    let values: Vec<f64> = series.values().collect();
    let mut problem =
        PulseProblem { series, values, times: series.times().collect(), shading, exposure_s, start: Vec::new() };
    let start_with_duty = |i: u32| problem.start_values(frequency_hz, middle, f64::from(i + 1) / f64::from(DUTIES + 1));
    let (start, _) = (0..DUTIES).filter_map(start_with_duty).min_by(|a, b| a.1.total_cmp(&b.1))?;
    // Exposures of half a period cannot distinguish pulses of duty cycle d from those of duty cycle 1 − d with the same middle,
    // less a constant light.
    let [middle, duty] = [PHASE, DUTY].map(|i| start[i]);
    let dual = problem.start_values(frequency_hz, middle, 1.0 - duty).map(|(dual, _)| dual);
    let fits: Vec<FittedPulses> =
        [Some(start), dual].into_iter().flatten().filter_map(|start| problem.fit_from(start)).collect();
    match &fits[..] {
        [] => None,
        [only] => Some(*only),
        [a, b, ..] if a.is_another(b) && a.fits_equally(b, problem.values.len()) => None,
        [a, b, ..] => Some(if a.squares <= b.squares { *a } else { *b }),
    }
}

impl FittedPulses {
    /// True if two fits describe different pulses, not the same minimum.
    fn is_another(&self, other: &Self) -> bool {
        (self.light.duty.value - other.light.duty.value).abs() > 1e-3
    }

    /// True if the readings, `count` of them, do not prefer one fit by two standard deviations.
    fn fits_equally(&self, other: &Self, count: usize) -> bool {
        (self.squares - other.squares).abs() < 4.0 * self.squares.min(other.squares) / count as f64
    }
}

/// Extremes of exposures of k T + r to pulses of mean 1: their light is between k d T + max(0, r − (1 − d) T) and k d T + min(r,
/// d T).
fn extremes(frequency_hz: f64, duty: f64, exposure_s: f64) -> [f64; 2] {
    let periods = exposure_s * frequency_hz;
    let (whole_periods, rest) = (periods.floor(), periods - periods.floor());
    [(rest - (1.0 - duty)).max(0.0), rest.min(duty)].map(|part| (whole_periods * duty + part) / (periods * duty))
}

/// Modulation, with the covariance of pulse fraction, frequency and duty cycle.
fn modulation_of(fitted: &Fit, exposure_s: f64) -> Estimate {
    let modulation = |p: [f64; 3]| {
        let [low, high] = extremes(p[1], p[2], exposure_s).map(|exposed| 1.0 - p[0] + p[0] * exposed);
        (high - low) / (high + low)
    };
    let places = [PULSED, FREQUENCY, DUTY];
    let at = places.map(|i| fitted.parameters[i]);
    let slope = |i: usize| {
        let step = 1e-6 * at[i];
        let [mut below, mut above] = [at; 2];
        (below[i], above[i]) = (at[i] - step, at[i] + step);
        (modulation(above) - modulation(below)) / (2.0 * step)
    };
    let slopes = [0, 1, 2].map(slope);
    let terms = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let variance: f64 = terms.map(|(i, j)| slopes[i] * fitted.covariance.at(places[i], places[j]) * slopes[j]).sum();
    Estimate::new(modulation(at), variance.max(0.0).sqrt())
}

impl PulseProblem<'_> {
    /// The fit from a start; `None` if it fails, or if the light between the pulses is negative (a pulse fraction above 1 by more
    /// than three standard uncertainties).
    fn fit_from(&mut self, start: Vec<f64>) -> Option<FittedPulses> {
        self.start = start;
        let result = fit(&*self, &self.start).ok()?;
        let [pulsed, duty] = [PULSED, DUTY].map(|i| result.estimate(i));
        let known = [pulsed, duty].iter().all(|e| e.standard_uncertainty.is_finite());
        let is_valid = pulsed.value > 0.0 && pulsed.value <= 1.0 + 3.0 * pulsed.standard_uncertainty;
        let squares = result.residuals.iter().flatten().map(|r| r * r).sum();
        let light = PulseLight { duty, pulsed_fraction: pulsed, modulation: modulation_of(&result, self.exposure_s) };
        (known && is_valid).then(|| FittedPulses { light, frequency_hz: result.estimate(FREQUENCY), squares })
    }

    fn waveform(frequency_hz: f64, middle: f64, duty: f64) -> Option<Waveform> {
        let pulses = Pulses { frequency_hz, duty, edges_s: [0.0; 2], peak: 1.0 / duty };
        Waveform::pulses(&pulses).ok().map(|waveform| waveform.later((middle - 0.5 * duty) / frequency_hz))
    }

    /// Light that the exposures receive from pulses of mean 1.
    fn exposed_light(&self, waveform: &Waveform) -> Option<Vec<f64>> {
        let over =
            |(time_s, _): &(f64, f64)| Some(waveform.mean(TimeInterval::new(*time_s, time_s + self.exposure_s)?));
        self.times.iter().map(over).collect()
    }

    /// Parameters for a duty cycle, and the sum of squares of their residuals; `None` if the pulses or the remaining light would be
    /// negative.
    fn start_values(&self, frequency_hz: f64, middle: f64, duty: f64) -> Option<(Vec<f64>, f64)> {
        let exposed = self.exposed_light(&Self::waveform(frequency_hz, middle, duty)?)?;
        let columns = [&[vec![1.0; exposed.len()], exposed], &self.shading[..]].concat();
        let (coefficients, squares) = explained(self.series, &columns)?;
        let level = coefficients[0] + coefficients[1];
        let pulsed = coefficients[1] / level;
        let is_valid = level > 0.0 && pulsed > 0.0 && pulsed <= 1.0 + PULSED_SLACK;
        let head = [level, pulsed, frequency_hz, middle, duty];
        let all = [&head[..], &coefficients[2..]].concat();
        is_valid.then_some((all, squares))
    }
}

impl Problem for PulseProblem<'_> {
    type State = Vec<f64>;

    fn state(&self, parameters: &[f64]) -> Option<Vec<f64>> {
        let [level, pulsed, frequency_hz, middle, duty] = *parameters.first_chunk::<5>()?;
        let is_valid = duty > 1e-4 && duty < 1.0 - 1e-4 && frequency_hz > 0.0;
        let exposed = self.exposed_light(&is_valid.then(|| Self::waveform(frequency_hz, middle, duty)).flatten()?)?;
        let shading = |i: usize| -> f64 {
            self.shading.iter().zip(&parameters[SHADING..]).map(|(column, c)| c * column[i]).sum()
        };
        let row_value = |(i, value): (usize, f64)| level * (1.0 - pulsed + pulsed * value) + shading(i);
        Some(exposed.into_iter().enumerate().map(row_value).collect())
    }

    fn blocks(&self) -> usize {
        1
    }

    fn residuals(&self, state: &Vec<f64>, _block: usize) -> Option<Vec<f64>> {
        Some(self.values.iter().zip(state).map(|(value, model)| value - model).collect())
    }

    fn depends(&self, _block: usize, _parameter: usize) -> bool {
        true
    }

    fn reach(&self, parameter: usize) -> f64 {
        match parameter {
            PULSED => 0.1,
            FREQUENCY => 0.1 / self.series.length_s(),
            PHASE | DUTY => 0.1,
            _ => 0.1 * self.start[0],
        }
    }
}
