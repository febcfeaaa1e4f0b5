//! Means of frames, one after the other.

use super::FlickerTiming;
use super::time_series::TimeSeries;
use crate::Estimate;

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
