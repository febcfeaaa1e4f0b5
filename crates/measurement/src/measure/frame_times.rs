//! Times of the measured frames: from the caller, otherwise from their side-cars.

use std::path::PathBuf;

use etendue_io::failure::Error;
use etendue_io::photograph::{StatedRows, StatedTiming, stated_timing};

/// Maximum relative difference of two statements that counts as rounding.
const ALIKE: f64 = 1e-6;

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
pub(super) fn completed(frames: &[PathBuf], given: FrameTimes) -> Result<(FrameTimes, Vec<String>), Error> {
    let stated: Option<Vec<StatedTiming>> =
        frames.iter().map(|file| stated_timing(file)).collect::<Result<_, _>>().map_err(Error::input)?;
    let Some((stated, first)) = stated.as_ref().and_then(|stated| Some((stated, stated.first()?))) else {
        return Ok((given, Vec::new()));
    };
    let mut told = Told { side_car: first.file.display().to_string(), taken: Vec::new(), notes: Vec::new() };
    let row_time_us = row_time_s(stated, &mut told).map(|s| 1e6 * s);
    let rate_hz = frame_rate_hz(stated, &mut told);
    let exposure_us = exposure_s(stated, &mut told).map(|s| 1e6 * s);
    let times = FrameTimes {
        row_time_us: told.chosen("row_time_us", "row time", "µs", given.row_time_us, row_time_us),
        frame_rate_hz: told.chosen("frame_rate_hz", "frame rate", "Hz", given.frame_rate_hz, rate_hz),
        exposure_us: told.chosen("exposure_us", "exposure", "µs", given.exposure_us, exposure_us),
    };
    Ok((times, told.into_notes()))
}

/// Report on the origin of the times.
struct Told {
    side_car: String,
    /// Times from the side-car.
    taken: Vec<String>,
    notes: Vec<String>,
}

impl Told {
    /// Returns the caller's number, otherwise the side-car's.
    fn chosen(&mut self, field: &str, name: &str, unit: &str, given: Option<f64>, said: Option<f64>) -> Option<f64> {
        match (given, said) {
            (Some(given), Some(said)) if (given - said).abs() > ALIKE * said.abs() => {
                let side_car = &self.side_car;
                self.notes.push(format!("`{field}` {given} is used; {side_car} states {} {unit}", rounded(said)));
            }
            (None, Some(said)) => self.taken.push(format!("{name} {} {unit}", rounded(said))),
            _ => {}
        }
        given.or(said)
    }

    fn into_notes(mut self) -> Vec<String> {
        if !self.taken.is_empty() {
            self.notes.push(format!("from {}: {}", self.side_car, self.taken.join(", ")));
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
fn row_time_s(stated: &[StatedTiming], told: &mut Told) -> Option<f64> {
    if stated.iter().any(|frame| frame.rows != stated[0].rows) {
        told.notes.push("the frames' side-cars state different shutters; rows are not measured".to_owned());
        return None;
    }
    match &stated[0].rows {
        StatedRows::Downwards { row_time_s } => Some(*row_time_s).filter(|s| *s > 0.0),
        StatedRows::Unknown | StatedRows::Together => None,
        StatedRows::Otherwise(why) => {
            told.notes.push(format!(
                "{}: {why}, which this measurement does not support; only frames are measured",
                told.side_car
            ));
            None
        }
    }
}

/// Common value of frames that follow each other by equal numbers of periods.
fn frame_rate_hz(stated: &[StatedTiming], told: &mut Told) -> Option<f64> {
    let period_s = stated[0].frame_period_s?;
    if stated.iter().any(|frame| frame.file != stated[0].file || frame.frame_period_s != Some(period_s)) {
        return None;
    }
    let numbers: Vec<u32> = stated.iter().map(|frame| frame.frame).collect::<Option<_>>()?;
    let [first, second, ..] = numbers[..] else { return None };
    let step = second.checked_sub(first).filter(|step| *step > 0);
    let even = step.filter(|step| numbers.windows(2).all(|pair| pair[1].checked_sub(pair[0]) == Some(*step)));
    if even.is_none() {
        told.notes.push("the frames are not equally spaced in time, so they have no frame rate".to_owned());
    }
    even.map(|step| 1.0 / (f64::from(step) * period_s))
}

/// Common value of all frames, if exposure control did not change it.
fn exposure_s(stated: &[StatedTiming], told: &mut Told) -> Option<f64> {
    let first = stated[0].exposure_s?;
    let same = stated.iter().all(|frame| frame.exposure_s == Some(first));
    if !same {
        told.notes.push("the exposure changes from frame to frame and is treated as unknown".to_owned());
    }
    same.then_some(first).filter(|s| *s > 0.0)
}
