//! Input images of a measurement: common arguments, progress, and clipped readings.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fmt::Display, path::Path};

use clap::Args;
use etendue_core::observer::{Observer, Progress, ProgressUnit};
use etendue_io::failure::{Error, ErrorCode, InputError};
use etendue_metrology::Image;

use super::readings::{Readings, Selection, SignalLevels};
use super::truth::{Truth, TruthInput};
use crate::report::Report;

/// A number of images, read by several threads.
pub(crate) struct ImageProgress<'a> {
    pub(crate) heading: &'a str,
    pub(crate) done: AtomicUsize,
    pub(crate) total: usize,
    pub(crate) observer: &'a dyn Observer,
}

impl ImageProgress<'_> {
    /// Counts one more image as read.
    pub(crate) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.observer.progress(Progress {
            heading: self.heading,
            frame: None,
            unit: ProgressUnit::Images,
            done,
            total: self.total,
        });
    }
}

/// Choice of the readings to measure, their meaning, and the position of the chart in them.
#[derive(Args, Clone, Debug, Default)]
pub struct MeasurementInput {
    /// Part and channel.
    #[command(flatten)]
    pub selection: Selection,
    /// Meaning of the numbers, where the file does not state it.
    #[command(flatten)]
    pub levels: SignalLevels,
    /// The chart and its position.
    #[command(flatten)]
    pub truth: TruthInput,
}

impl MeasurementInput {
    /// Readings of an image, proportional to light.
    pub(crate) fn linear(&self, image: &Path) -> Result<Readings, Error> {
        self.selection.linear(image)
    }

    /// Refuses a reading without light where only differences of readings matter.
    pub(crate) fn check_without_black(&self) -> Result<(), Error> {
        match self.levels.black {
            None => Ok(()),
            Some(_) => Err(Error::argument(
                "black",
                "`black`: has no effect here, as only differences of readings are used; leave it out",
            )
            .with_code(ErrorCode::NoEffect)),
        }
    }

    /// Ground truth of an image, if given: of one of these charts, and of the image's size.
    pub(crate) fn truth(&self, charts: &[&str], image: &Path, readings: &Readings) -> Result<Option<Truth>, Error> {
        let truth = self.truth.read(charts)?;
        truth.iter().try_for_each(|truth| truth.fits(image, readings))?;
        Ok(truth)
    }
}

/// Error of an image.
pub(crate) fn refused(image: &Path, error: impl Display) -> Error {
    let input_error = InputError::new(ErrorCode::NotMeasurable, format!("{}: {error}", image.display()));
    Error::input(InputError { file: Some(image.to_path_buf()), ..input_error })
}

/// Minimum fraction of a region's readings at its minimum or maximum from which the region counts as clipped.
const MIN_CLIPPED_FRACTION: f64 = 0.01;
/// Readings from this value on are not integers of a digital format.
const MAX_INTEGER: f32 = 16_777_216.0;

/// Clipping of the readings of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Clipping {
    /// All readings are equal.
    Throughout { reading: f32 },
    /// At 0.
    Black { fraction: f64 },
    /// At the full scale, or, if that is not known, at the maximum of 8 or more bits.
    Clipped { reading: f32, fraction: f64 },
}

impl Clipping {
    /// Examines the readings of a region; `None` if too few are clipped to affect the result.
    pub(crate) fn from_region(region: &Image, full_scale: Option<f64>) -> Option<Self> {
        let samples = region.samples();
        let fraction = |is_cut: &dyn Fn(f32) -> bool| {
            samples.iter().filter(|sample| is_cut(**sample)).count() as f64 / samples.len() as f64
        };
        let (low, high) =
            samples.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), s| (low.min(*s), high.max(*s)));
        // The maximum of 8, 10, 12, … bits.
        let is_of_bits = |reading: f32| {
            (255.0..MAX_INTEGER).contains(&reading) && reading.fract() == 0.0 && (reading as u32 + 1).is_power_of_two()
        };
        let is_full = full_scale.map_or_else(|| is_of_bits(high), |full| f64::from(high) >= full);
        let black = fraction(&|sample| sample <= 0.0);
        let clipped = fraction(&|sample| full_scale.map_or(sample == high, |full| f64::from(sample) >= full));
        match (
            low == high && (low <= 0.0 || is_full),
            black > MIN_CLIPPED_FRACTION,
            is_full && clipped > MIN_CLIPPED_FRACTION,
        ) {
            (true, ..) => Some(Self::Throughout { reading: low }),
            (_, true, _) => Some(Self::Black { fraction: black }),
            (.., true) => Some(Self::Clipped { reading: high, fraction: clipped }),
            _ => None,
        }
    }

    /// Returns a description for notes.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Throughout { reading } => {
                format!("100.0 % of the readings are {reading}: entirely black or saturated")
            }
            Self::Black { fraction } => {
                format!("{:.1} % of the readings are black, 0 or less: darker values are clipped", 100.0 * fraction)
            }
            Self::Clipped { reading, fraction } => {
                format!("{:.1} % of the readings are clipped at {reading}: brighter values are lost", 100.0 * fraction)
            }
        }
    }
}

impl Report {
    /// Adds a note if the readings of a region are clipped, which the result does not account for.
    pub(crate) fn note_cut(&mut self, name: &str, region: &Image, full_scale: Option<f64>) {
        if let Some(cut) = Clipping::from_region(region, full_scale) {
            self.note(format!("{name}: {}; the result and its uncertainty do not account for it", cut.words()));
        }
    }
}

/// Returns the name of a region from its position.
pub(crate) fn region_label(kind: &str, [x, y, width, height]: [usize; 4]) -> String {
    format!("{kind} {x},{y},{width},{height}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hundred readings, `count` of them clipped at `reading`.
    fn cut(count: usize, reading: f32, full_scale: Option<f64>) -> Option<Clipping> {
        let sample = |i: usize| if i < count { reading } else { 100.0 + i as f32 };
        Clipping::from_region(
            &Image::from_samples(10, 10, (0..100).map(sample).collect()).expect("full rows"),
            full_scale,
        )
    }

    #[test]
    fn a_region_counts_as_clipped_above_one_percent() {
        assert_eq!([cut(0, 0.0, None), cut(1, 0.0, None), cut(1, 255.0, None)], [None; 3]);
        assert_eq!(cut(2, 0.0, None), Some(Clipping::Black { fraction: 0.02 }));
        assert_eq!(cut(30, 255.0, None), Some(Clipping::Clipped { reading: 255.0, fraction: 0.3 }));
        assert_eq!(cut(30, 250.0, None), None, "not the maximum of any number of bits");
        assert_eq!(cut(30, 250.0, Some(250.0)), Some(Clipping::Clipped { reading: 250.0, fraction: 0.3 }));
        assert_eq!(cut(100, 0.0, None), Some(Clipping::Throughout { reading: 0.0 }));
        assert_eq!(cut(100, 128.0, None), None, "a uniform grey is not clipped");
    }

    #[test]
    fn a_note_states_the_region_and_its_clipped_fraction() {
        let mut report = Report::new("test", "test");
        let half = Image::from_samples(2, 1, vec![0.0, 9.0]).expect("a row");
        report.note_cut(&region_label("trap", [1, 2, 3, 4]), &half, None);
        let expected = "trap 1,2,3,4: 50.0 % of the readings are black, 0 or less: darker values are clipped; the result and its uncertainty do not account for it";
        assert_eq!(report.notes(), [expected]);
    }
}
