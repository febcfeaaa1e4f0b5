//! Bands over the rows of a rolling shutter.

use core::f64::consts::PI;

use etendue_core::maths::f64::sin;

use super::pulses::{self, PulseLight};
use super::series::{FlickerTiming, weighted_mean};
use super::time_series::{FourierFit, TimeSeries, criterion};
use crate::Estimate;

/// Minimum attenuation factor of the fundamental by an exposure that is still corrected.
const MIN_ATTENUATION: f64 = 0.05;

/// Bands over the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct RowFlicker {
    /// Detected bands; `None` if none are significant.
    pub bands: Option<RowBands>,
    /// Lowest detectable frequency, Hz: one and a half periods in all.
    pub lowest_hz: f64,
    /// Highest detectable frequency, Hz: two rows per period.
    pub highest_hz: f64,
}

/// Modulation over the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct RowBands {
    /// Frequency of the light, Hz.
    pub frequency_hz: Estimate,
    /// Rows per period of the bands.
    pub period_rows: Estimate,
    /// (max − min)/(max + min) over a period, in the rows.
    pub modulation: Estimate,
    /// Amplitude of the fundamental over the mean, in the rows.
    pub amplitude_ratio: Estimate,
    /// The same for the light itself; `None` if the exposure is not known or attenuates too much.
    pub light_amplitude_ratio: Option<Estimate>,
    /// Duty cycle, and pulsed fraction of the light; `None` if the light is not pulsed, or the exposure is not known.
    pub pulses: Option<PulseLight>,
    /// Number of fitted harmonics, including the fundamental.
    pub harmonics: usize,
    /// True if shading over the rows was fitted as well.
    pub shading: bool,
}

pub(super) fn measure(rows: &[Vec<f64>], row_time_s: f64, timing: &FlickerTiming) -> RowFlicker {
    let highest_hz = 0.5 / row_time_s;
    let block =
        |(n, values): (usize, &Vec<f64>)| (timing.frame_rate_hz.map_or(0.0, |rate| n as f64 / rate), values.clone());
    let same_clock = timing.frame_rate_hz.is_some() || rows.len() == 1;
    let row_series = |blocks: Vec<(f64, Vec<f64>)>| TimeSeries { blocks, step_s: row_time_s };
    let all: Vec<TimeSeries> = match same_clock {
        true => vec![row_series(rows.iter().enumerate().map(block).collect())],
        false => rows.iter().map(|values| row_series(vec![(0.0, values.clone())])).collect(),
    };
    let row_bands = joined(&all.iter().filter_map(|series| bands(series, timing)).collect::<Vec<_>>());
    let lowest_hz = all.iter().map(TimeSeries::lowest_hz).fold(f64::INFINITY, f64::min);
    RowFlicker { bands: row_bands, lowest_hz, highest_hz }
}

fn bands(series: &TimeSeries, timing: &FlickerTiming) -> Option<RowBands> {
    let fit = series.find_frequency(0.5 / series.step_s).filter(|fit| fit.mean() > 0.0)?;
    let frequency_hz = fit.frequency_hz;
    let pulses = timing.exposure_s.and_then(|exposure_s| pulses(series, &fit, exposure_s));
    let frequency_hz = pulses.as_ref().map_or(frequency_hz, |(_, frequency_hz)| *frequency_hz);
    let period_rows = 1.0 / (frequency_hz.value * series.step_s);
    Some(RowBands {
        frequency_hz,
        period_rows: Estimate::new(period_rows, period_rows * frequency_hz.standard_uncertainty / frequency_hz.value),
        modulation: pulses.as_ref().map_or_else(|| fit.michelson(), |(pulses, _)| pulses.modulation),
        amplitude_ratio: fit.amplitude_ratio(),
        light_amplitude_ratio: timing.exposure_s.and_then(|exposure_s| undone(&fit, exposure_s)),
        pulses: pulses.map(|(pulses, _)| pulses),
        harmonics: fit.harmonics,
        shading: fit.shading,
    })
}

/// The fundamental before integration by the exposure.
fn undone(fit: &FourierFit, exposure_s: f64) -> Option<Estimate> {
    let x = PI * fit.frequency_hz.value * exposure_s;
    let left = (sin(x) / x).abs();
    (left >= MIN_ATTENUATION).then(|| fit.amplitude_ratio().scaled(1.0 / left))
}

/// Pulses, if the criterion prefers them to the series.
fn pulses(series: &TimeSeries, fit: &FourierFit, exposure_s: f64) -> Option<(PulseLight, Estimate)> {
    let fitted_pulses = pulses::fitted(series, fit, exposure_s)?;
    let fourier_criterion = criterion(fit.squares, fit.count, fit.parameters);
    let pulse_criterion = criterion(fitted_pulses.squares, fit.count, fit.level_parameters() + 4);
    (pulse_criterion < fourier_criterion).then_some((fitted_pulses.light, fitted_pulses.frequency_hz))
}

/// For frames at unknown times: the mean of each quantity over the frames that have it.
fn joined(each: &[RowBands]) -> Option<RowBands> {
    let first = each.first()?;
    if each.len() == 1 {
        return Some(first.clone());
    }
    let mean = |quantity: fn(&RowBands) -> Option<Estimate>| {
        weighted_mean(&each.iter().filter_map(quantity).collect::<Vec<_>>())
    };
    let duty = mean(|bands| bands.pulses.map(|pulses| pulses.duty));
    let pulsed = mean(|bands| bands.pulses.map(|pulses| pulses.pulsed_fraction));
    let modulation = mean(|bands| bands.pulses.map(|pulses| pulses.modulation));
    Some(RowBands {
        frequency_hz: mean(|bands| Some(bands.frequency_hz))?,
        period_rows: mean(|bands| Some(bands.period_rows))?,
        modulation: mean(|bands| Some(bands.modulation))?,
        amplitude_ratio: mean(|bands| Some(bands.amplitude_ratio))?,
        light_amplitude_ratio: mean(|bands| bands.light_amplitude_ratio),
        pulses: duty.zip(pulsed).zip(modulation).map(|((duty, pulsed), modulation)| PulseLight {
            duty,
            pulsed_fraction: pulsed,
            modulation,
        }),
        ..first.clone()
    })
}
