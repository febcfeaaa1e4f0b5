//! Times of the measured frames: from the caller, otherwise from their side-cars.

use std::path::PathBuf;

use etendue_io::failure::Error;
use etendue_io::photograph::{StatedRows, StatedTiming, stated_timing};

/// Maximum relative difference of two statements that counts as rounding.
const MAX_ROUNDING: f64 = 1e-6;

/// Times of frames, as far as known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrameTimes {
    /// Time from row to row of the file, µs.
    pub(super) row_time_us: Option<f64>,
    /// Frames per second.
    pub(super) frame_rate_hz: Option<f64>,
    /// Exposure of a row, µs.
    pub(super) exposure_us: Option<f64>,
}

/// Returns the times of `given`, completed from the frames' side-cars, and notes for the user.
pub(super) fn completed(frames: &[PathBuf], stated_times: FrameTimes) -> Result<(FrameTimes, Vec<String>), Error> {
    let stated: Option<Vec<StatedTiming>> =
        frames.iter().map(|file| stated_timing(file)).collect::<Result<_, _>>().map_err(Error::input)?;
    let Some((stated, first)) = stated.as_ref().and_then(|stated| Some((stated, stated.first()?))) else {
        return Ok((stated_times, Vec::new()));
    };
    let mut sources =
        TimeSources { side_car: first.file.display().to_string(), notes_taken: Vec::new(), notes: Vec::new() };
    let row_time_us = row_time_s(stated, &mut sources).map(|s| 1e6 * s);
    let rate_hz = frame_rate_hz(stated, &mut sources);
    let exposure_us = exposure_s(stated, &mut sources).map(|s| 1e6 * s);
    let times = FrameTimes {
        row_time_us: sources.chosen("row_time_us", "row time", "µs", stated_times.row_time_us, row_time_us),
        frame_rate_hz: sources.chosen("frame_rate_hz", "frame rate", "Hz", stated_times.frame_rate_hz, rate_hz),
        exposure_us: sources.chosen("exposure_us", "exposure", "µs", stated_times.exposure_us, exposure_us),
    };
    Ok((times, sources.into_notes()))
}

/// Report on the origin of the times.
struct TimeSources {
    side_car: String,
    /// Times from the side-car.
    notes_taken: Vec<String>,
    notes: Vec<String>,
}

impl TimeSources {
    /// Returns the caller's number, otherwise the side-car's.
    fn chosen(
        &mut self,
        field: &str,
        name: &str,
        unit: &str,
        requested: Option<f64>,
        recorded: Option<f64>,
    ) -> Option<f64> {
        match (requested, recorded) {
            (Some(requested), Some(recorded)) if (requested - recorded).abs() > MAX_ROUNDING * recorded.abs() => {
                let side_car = &self.side_car;
                self.notes
                    .push(format!("`{field}` {requested} is used; {side_car} states {} {unit}", rounded(recorded)));
            }
            (None, Some(value)) => self.notes_taken.push(format!("{name} {} {unit}", rounded(value))),
            _ => {}
        }
        requested.or(recorded)
    }

    fn into_notes(mut self) -> Vec<String> {
        if !self.notes_taken.is_empty() {
            self.notes.push(format!("from {}: {}", self.side_car, self.notes_taken.join(", ")));
        }
        self.notes
    }
}

/// Formats a number without the rounding error of a unit's factor.
fn rounded(value: f64) -> String {
    let digits = format!("{value:.9e}");
    digits.parse::<f64>().map_or(digits, |value| value.to_string())
}

/// Common value of all frames, if they agree.
fn row_time_s(stated: &[StatedTiming], sources: &mut TimeSources) -> Option<f64> {
    if stated.iter().any(|frame| frame.rows != stated[0].rows) {
        sources.notes.push("the frames' side-cars state different shutters; rows are not measured".to_owned());
        return None;
    }
    match &stated[0].rows {
        StatedRows::Downwards { row_time_s } => Some(*row_time_s).filter(|s| *s > 0.0),
        StatedRows::Unknown | StatedRows::Together => None,
        StatedRows::Otherwise(reason) => {
            sources.notes.push(format!(
                "{}: {reason}, which this measurement does not support; only frames are measured",
                sources.side_car
            ));
            None
        }
    }
}

/// Common value of frames that follow each other by equal numbers of periods.
fn frame_rate_hz(stated: &[StatedTiming], sources: &mut TimeSources) -> Option<f64> {
    let period_s = stated[0].frame_period_s?;
    if stated.iter().any(|frame| frame.file != stated[0].file || frame.frame_period_s != Some(period_s)) {
        return None;
    }
    let numbers: Vec<u32> = stated.iter().map(|frame| frame.frame).collect::<Option<_>>()?;
    let [first, second, ..] = numbers[..] else { return None };
    let step = second.checked_sub(first).filter(|step| *step > 0);
    let constant_step = step.filter(|step| numbers.windows(2).all(|pair| pair[1].checked_sub(pair[0]) == Some(*step)));
    if constant_step.is_none() {
        sources.notes.push("the frames are not equally spaced in time, so they have no frame rate".to_owned());
    }
    constant_step.map(|step| 1.0 / (f64::from(step) * period_s))
}

/// Common value of all frames, if exposure control did not change it.
fn exposure_s(stated: &[StatedTiming], sources: &mut TimeSources) -> Option<f64> {
    let first = stated[0].exposure_s?;
    let same = stated.iter().all(|frame| frame.exposure_s == Some(first));
    if !same {
        sources.notes.push("the exposure changes from frame to frame and is treated as unknown".to_owned());
    }
    same.then_some(first).filter(|s| *s > 0.0)
}
