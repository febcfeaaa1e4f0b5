//! From frames to numbers over time.

use super::time_series::TimeSeries;
use crate::{Estimate, Image};

/// Mean of each row, less black.
pub(super) fn row_means(frame: &Image, black: f64) -> Vec<f64> {
    let mean = |row: &[f32]| row.iter().map(|v| f64::from(*v)).sum::<f64>() / row.len() as f64 - black;
    frame.samples().chunks_exact(frame.width()).map(mean).collect()
}

/// Mean of a frame, less black; its uncertainty from the scatter of its columns, which see the same bands.
pub(super) fn frame_mean(frame: &Image, black: f64) -> Estimate {
    let (columns, rows) = (frame.width(), frame.height());
    let column = |x: usize| (0..rows).map(|y| f64::from(frame.at(x, y))).sum::<f64>() / rows as f64 - black;
    let means: Vec<f64> = (0..columns).map(column).collect();
    let mean = means.iter().sum::<f64>() / columns as f64;
    let squares: f64 = means.iter().map(|m| (m - mean) * (m - mean)).sum();
    Estimate::new(mean, (squares / ((columns - 1) * columns) as f64).sqrt())
}

/// Mean of several.
pub(super) fn mean_of(all: &[Estimate]) -> Estimate {
    let count = all.len() as f64;
    let squares: f64 = all.iter().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum();
    Estimate::new(all.iter().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count)
}

/// Mean of several of one quantity, by what each knows of it.
pub(super) fn weighted_mean(all: &[Estimate]) -> Option<Estimate> {
    let weight = |e: &Estimate| 1.0 / (e.standard_uncertainty * e.standard_uncertainty);
    let total: f64 = all.iter().map(weight).sum();
    let known = !all.is_empty() && total > 0.0 && total.is_finite();
    known.then(|| Estimate::new(all.iter().map(|e| e.value * weight(e)).sum::<f64>() / total, 1.0 / total.sqrt()))
}

/// Least frames in which a frequency is looked for.
const MIN_FRAMES: usize = 8;

/// How frames differ.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameFlicker {
    /// (greatest − least)/(greatest + least) of the frames' means.
    pub modulation: Estimate,
    /// The frequency at which frames go up and down; `None` where the frame rate is not known, frames are few, or nothing does that
    /// chance would not.
    pub frequency: Option<FrameFrequency>,
    /// How often bands of the rows' frequency come back to their place a second, Hz, by the frame rate: what is left of the
    /// frequency over whole frame rates.
    pub beat_hz: Option<Estimate>,
}

/// The frequency at which frames go up and down.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameFrequency {
    /// As seen, up to half the frame rate, Hz.
    pub seen_hz: Estimate,
    /// Amplitude of the fundamental over the mean.
    pub amplitude_ratio: Estimate,
    /// The frame rate, Hz: the light's frequency is a multiple of it plus or minus what is seen.
    pub frame_rate_hz: f64,
}

impl FrameFrequency {
    /// Frequencies that look alike, with how many frame rates they are beyond: the lowest so many.
    #[must_use]
    pub fn alike(&self, count: usize) -> Vec<(u32, f64)> {
        let orders = (0_u32..).flat_map(|k| {
            let base = f64::from(k) * self.frame_rate_hz;
            let below = (k > 0).then_some((k, base - self.seen_hz.value));
            below.into_iter().chain([(k, base + self.seen_hz.value)])
        });
        orders.take(count).collect()
    }
}

pub(super) fn measure(means: &[Estimate], timing: &FlickerTiming, rows_hz: Option<Estimate>) -> FrameFlicker {
    let values: Vec<f64> = means.iter().map(|mean| mean.value).collect();
    let frequency = timing.frame_rate_hz.filter(|_| means.len() >= MIN_FRAMES).and_then(|frame_rate_hz| {
        let series = TimeSeries { blocks: vec![(0.0, values)], step_s: 1.0 / frame_rate_hz };
        let fit = series.found(0.5 * frame_rate_hz).filter(|fit| fit.mean() > 0.0)?;
        Some(FrameFrequency { seen_hz: fit.frequency_hz, amplitude_ratio: fit.amplitude_ratio(), frame_rate_hz })
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
    let [of_high, of_low] = [low.value * high.standard_uncertainty, high.value * low.standard_uncertainty];
    let u = 2.0 * (of_high * of_high + of_low * of_low).sqrt() / (total * total);
    Estimate::new((high.value - low.value) / total, u)
}

/// When rows and frames were exposed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlickerTiming {
    /// From one row of the images to the next, s; `None` where all rows are exposed together.
    pub row_time_s: Option<f64>,
    /// Frames a second; `None` where it is not known.
    pub frame_rate_hz: Option<f64>,
    /// How long each row is exposed, s; `None` where it is not known.
    pub exposure_s: Option<f64>,
}
