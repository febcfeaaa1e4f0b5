//! Flicker: modulated light in the rows of a rolling shutter and the frames of a sequence.
//!
//! **Rows.** Row y of frame n is exposed from t = n/f_frame + y · t_row on, for the exposure t_e. The means of the rows are
//! fitted by a level, a slope and a curvature over the rows (shading; omitted for fewer than three periods) and a Fourier series
//! of the frequency f,
//!
//! ```text
//! s(y, n) = Σ_k c_k u^k + Σ_h a_h cos 2πhft + b_h sin 2πhft        u: −1 … 1 over the rows
//! ```
//!
//! f is the frequency whose fundamental explains most (periodogram, then least squares); the number of harmonics, at most seven,
//! is the one that the Bayesian information criterion (Schwarz 1978) supports. Frames of a known rate are fitted together, so
//! that the whole sequence determines f; frames of an unknown rate are fitted separately. No flicker is reported if the
//! fundamental improves the criterion less than chance would among that many frequencies.
//!
//! **Modulation** in two measures: (max − min)/(max + min), the flicker modulation index of IEEE P2020 and Michelson contrast,
//! over rows from the fitted pulses or series and over frames from the extremes of their means; and the fundamental's amplitude
//! over the mean.
//!
//! **The light itself.** An exposure attenuates the fundamental by sin(πft_e)/(πft_e), which is corrected if the exposure is
//! known and the factor exceeds a twentieth. Pulses of a duty cycle d are fitted as their exact means over the exposures (a
//! trapezoid), with f, phase, duty cycle, pulse and constant light free; they are reported if the criterion prefers them to the
//! series.
//!
//! **Frames alone** determine frequencies only up to half the frame rate: f = |k f_frame ± f_seen| for any k = 0, 1, 2, …
//!
//! Uncertainty: from the residuals of the fits, for the series with the correlation of neighbours (this includes row noise, but
//! not fixed patterns that look like bands); for extremes over frames from the scatter of columns, without the bias of extremes
//! due to noise. Limitations: light on only part of the region, rows read in fields or upwards.

mod pulses;
mod rows;
mod series;
#[cfg(test)]
mod tests;
mod time_series;

use crate::patch_statistics::{MAX_SATURATED_FRACTION, saturated_fraction};
use crate::{Estimate, Image};

pub use pulses::PulseLight;
pub use rows::{RowBands, RowFlicker};
pub use series::{FlickerTiming, FrameFlicker, FrameFrequency};

/// Flicker results.
#[derive(Clone, Debug, PartialEq)]
pub struct Flicker {
    /// Mean over all frames, less black.
    pub level: Estimate,
    /// Flicker over the rows; `None` without a row time.
    pub rows: Option<RowFlicker>,
    /// Flicker over the frames; `None` for a single frame.
    pub frames: Option<FrameFlicker>,
}

/// Reason why flicker cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlickerError {
    /// A single frame without a row time.
    #[error(
        "a single frame whose rows are exposed together does not show flicker: give the time from row to row (`row_time_us`), or several frames"
    )]
    NoTime,
    /// An invalid time.
    #[error("{what} is {value}: expected a number above 0")]
    Timing {
        /// Name of the time.
        what: &'static str,
        /// Value, in its unit.
        value: f64,
    },
    /// Too few rows.
    #[error("{rows} rows are too few to detect bands: give a region of at least {least} rows")]
    FewRows {
        /// Number of rows.
        rows: usize,
        /// Minimum.
        least: usize,
    },
    /// Too narrow.
    #[error("the noise of a region of {columns} columns cannot be estimated: give at least two columns")]
    Narrow {
        /// Number of columns.
        columns: usize,
    },
    /// Frames differ in size.
    #[error("the frames differ in size: give frames of one camera")]
    Sizes,
    /// Saturated pixels.
    #[error("{percent:.1} % of the region is saturated, which clips the peaks of the light: expose less")]
    Saturated {
        /// Percentage of saturated pixels.
        percent: f64,
    },
    /// No light.
    #[error("the mean reading {mean:.3} is not above the reading without light, {black:.3}: check `black`")]
    Dark {
        /// Mean of all frames.
        mean: f64,
        /// Reading without light.
        black: f64,
    },
}

/// Minimum number of rows of a region for the detection of bands.
const MIN_ROWS: usize = 16;

/// Measures the flicker of a uniformly lit region over frames.
///
/// # Errors
/// If times are missing or wrong, or the region is too small, saturated or dark.
pub fn measure_flicker(
    frames: &[Image],
    timing: &FlickerTiming,
    (black, full_scale): (f64, Option<f64>),
) -> Result<Flicker, FlickerError> {
    check_timing(timing, frames.len())?;
    check_frames(frames, timing, full_scale)?;
    let rows: Vec<Vec<f64>> = frames.iter().map(|frame| series::row_means(frame, black)).collect();
    let means = frames.iter().map(|frame| series::frame_mean(frame, black)).collect::<Vec<_>>();
    let level = series::mean_of(&means);
    if level.value <= 0.0 {
        return Err(FlickerError::Dark { mean: level.value + black, black });
    }
    let row_flicker = timing.row_time_s.map(|row_time_s| rows::measure(&rows, row_time_s, timing));
    let apparent_hz = row_flicker.as_ref().and_then(|rows| rows.bands.as_ref()).map(|band| band.frequency_hz);
    let frames = (frames.len() > 1).then(|| series::measure(&means, timing, apparent_hz));
    Ok(Flicker { level, rows: row_flicker, frames })
}

fn check_timing(timing: &FlickerTiming, frames: usize) -> Result<(), FlickerError> {
    let times = [
        ("the row time (s)", timing.row_time_s),
        ("the frame rate (Hz)", timing.frame_rate_hz),
        ("the exposure (s)", timing.exposure_s),
    ];
    for (name, value) in times {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return Err(FlickerError::Timing { what: name, value });
        }
    }
    if timing.row_time_s.is_none() && frames < 2 { Err(FlickerError::NoTime) } else { Ok(()) }
}

fn check_frames(frames: &[Image], timing: &FlickerTiming, full_scale: Option<f64>) -> Result<(), FlickerError> {
    let Some(first) = frames.first() else { return Err(FlickerError::NoTime) };
    let (columns, rows) = (first.width(), first.height());
    if frames.iter().any(|frame| (frame.width(), frame.height()) != (columns, rows)) {
        return Err(FlickerError::Sizes);
    }
    if columns < 2 {
        return Err(FlickerError::Narrow { columns });
    }
    if timing.row_time_s.is_some() && rows < MIN_ROWS {
        return Err(FlickerError::FewRows { rows, least: MIN_ROWS });
    }
    // Bands have plateaus of their own: clipping can be detected only with a known full scale.
    let Some(full_scale) = full_scale else { return Ok(()) };
    let fractions = frames.iter().map(|frame| saturated_fraction(frame.samples(), Some(full_scale)));
    let fraction = fractions.fold(0.0, f64::max);
    if fraction > MAX_SATURATED_FRACTION { Err(FlickerError::Saturated { percent: 100.0 * fraction }) } else { Ok(()) }
}
