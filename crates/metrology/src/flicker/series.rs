//! Conversion of frames to time series.

use super::time_series::TimeSeries;
use crate::{Estimate, Image};

/// Mean of each row, less black.
pub(super) fn row_means(frame: &Image, black: f64) -> Vec<f64> {
    let mean = |row: &[f32]| row.iter().map(|v| f64::from(*v)).sum::<f64>() / row.len() as f64 - black;
    frame.samples().chunks_exact(frame.width()).map(mean).collect()
}

/// Mean of a frame, less black; its uncertainty is from the scatter of its columns, which contain the same bands.
pub(super) fn frame_mean(frame: &Image, black: f64) -> Estimate {
    let (columns, rows) = (frame.width(), frame.height());
    let column = |x: usize| (0..rows).map(|y| f64::from(frame.at(x, y))).sum::<f64>() / rows as f64 - black;
    let means: Vec<f64> = (0..columns).map(column).collect();
    let mean = means.iter().sum::<f64>() / columns as f64;
    let squares: f64 = means.iter().map(|m| (m - mean) * (m - mean)).sum();
    Estimate::new(mean, (squares / ((columns - 1) * columns) as f64).sqrt())
}

/// Mean of several estimates.
pub(super) fn mean_of(all: &[Estimate]) -> Estimate {
    let count = all.len() as f64;
    let squares: f64 = all.iter().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum();
    Estimate::new(all.iter().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count)
}

/// Mean of several estimates of one quantity, weighted by their uncertainties.
pub(super) fn weighted_mean(all: &[Estimate]) -> Option<Estimate> {
    let weight = |e: &Estimate| 1.0 / (e.standard_uncertainty * e.standard_uncertainty);
    let total: f64 = all.iter().map(weight).sum();
    let known = !all.is_empty() && total > 0.0 && total.is_finite();
    known.then(|| Estimate::new(all.iter().map(|e| e.value * weight(e)).sum::<f64>() / total, 1.0 / total.sqrt()))
}

/// Minimum number of frames for the detection of a frequency.
const MIN_FRAMES: usize = 8;

/// Differences between frames.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameFlicker {
    /// (max − min)/(max + min) of the frames' means.
    pub modulation: Estimate,
    /// The frequency of the modulation over frames; `None` if the frame rate is not known, frames are few, or none is significant.
    pub frequency: Option<FrameFrequency>,
    /// Beat frequency, Hz, at which bands of the rows' frequency return to their place: the difference of the frequency from the
    /// nearest multiple of the frame rate.
    pub beat_hz: Option<Estimate>,
}

/// The frequency of the modulation over frames.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameFrequency {
    /// Apparent frequency, up to half the frame rate, Hz.
    pub apparent_hz: Estimate,
    /// Amplitude of the fundamental over the mean.
    pub amplitude_ratio: Estimate,
    /// Frame rate, Hz: the light's frequency is a multiple of it plus or minus the apparent one.
    pub frame_rate_hz: f64,
}

impl FrameFrequency {
    /// Indistinguishable frequencies (aliases), with their multiple of the frame rate: the lowest `count`.
    #[must_use]
    pub fn aliases(&self, count: usize) -> Vec<(u32, f64)> {
        let orders = (0_u32..).flat_map(|k| {
            let base = f64::from(k) * self.frame_rate_hz;
            let below = (k > 0).then_some((k, base - self.apparent_hz.value));
            below.into_iter().chain([(k, base + self.apparent_hz.value)])
        });
        orders.take(count).collect()
    }
}

pub(super) fn measure(means: &[Estimate], timing: &FlickerTiming, rows_hz: Option<Estimate>) -> FrameFlicker {
    let values: Vec<f64> = means.iter().map(|mean| mean.value).collect();
    let frequency = timing.frame_rate_hz.filter(|_| means.len() >= MIN_FRAMES).and_then(|frame_rate_hz| {
        let series = TimeSeries { blocks: vec![(0.0, values)], step_s: 1.0 / frame_rate_hz };
        let fit = series.find_frequency(0.5 * frame_rate_hz).filter(|fit| fit.mean() > 0.0)?;
        Some(FrameFrequency { apparent_hz: fit.frequency_hz, amplitude_ratio: fit.amplitude_ratio(), frame_rate_hz })
    });
    let beat = |(rate, f): (f64, Estimate)| {
        Estimate::new((f.value - (f.value / rate).round() * rate).abs(), f.standard_uncertainty)
    };
    FrameFlicker { modulation: extremes(means), frequency, beat_hz: timing.frame_rate_hz.zip(rows_hz).map(beat) }
}

fn extremes(means: &[Estimate]) -> Estimate {
    let by = |a: &&Estimate, b: &&Estimate| a.value.total_cmp(&b.value);
    let Some((low, high)) = means.iter().min_by(by).zip(means.iter().max_by(by)) else {
        return Estimate::new(0.0, f64::INFINITY);
    };
    let total = high.value + low.value;
    let [high_part, low_part] = [low.value * high.standard_uncertainty, high.value * low.standard_uncertainty];
    let u = 2.0 * (high_part * high_part + low_part * low_part).sqrt() / (total * total);
    Estimate::new((high.value - low.value) / total, u)
}

/// Exposure times of rows and frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlickerTiming {
    /// Time from one row of the images to the next, s; `None` if all rows are exposed together.
    pub row_time_s: Option<f64>,
    /// Frames per second; `None` if not known.
    pub frame_rate_hz: Option<f64>,
    /// Exposure of each row, s; `None` if not known.
    pub exposure_s: Option<f64>,
}
