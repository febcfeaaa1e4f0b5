//! Shutters: exposure interval of each row of a sensor.
//!
//! Times count from the start of the frame: the moment at which the first row begins its exposure.

use crate::TimeInterval;

/// Exposure timing of the rows of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shutter {
    /// All rows simultaneously.
    #[default]
    Global,
    /// Row by row: each for the whole exposure time, the next one later by the row time.
    Rolling(RowTiming),
    /// All rows begin simultaneously and are read one after the other. Each is exposed longer than the row before it by the row time; waiting rows stay exposed
    /// (global reset release).
    GlobalReset(RowTiming),
}

/// Order and rate of row readout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowTiming {
    /// Time from one row to the next that is read, s; 0 or more.
    pub row_time_s: f64,
    /// True if the last row is read first.
    pub upwards: bool,
    /// Number of interlaced fields of an image: 1 reads all rows in turn, 2 first all even rows, then all odd ones. At least 1.
    pub fields: u32,
}

impl RowTiming {
    /// Returns the number of rows that are read before `row` of `rows`.
    fn rank(&self, row: usize, rows: usize) -> usize {
        let row = if self.upwards { rows - 1 - row } else { row };
        let fields = self.fields as usize;
        let before = (0..row % fields).map(|field| rows.saturating_sub(field).div_ceil(fields)).sum::<usize>();
        before + row / fields
    }

    fn delay_s(&self, row: usize, rows: usize) -> f64 {
        self.rank(row, rows) as f64 * self.row_time_s
    }
}

impl Shutter {
    /// Returns the exposure interval of a row of `rows`, for the nominal exposure time `exposure_s`, counted from the frame's start.
    #[must_use]
    pub fn exposure(&self, row: usize, rows: usize, exposure_s: f64) -> TimeInterval {
        let (start_s, length_s) = match self {
            Self::Global => (0.0, exposure_s),
            Self::Rolling(timing) => (timing.delay_s(row, rows), exposure_s),
            Self::GlobalReset(timing) => (0.0, exposure_s + timing.delay_s(row, rows)),
        };
        TimeInterval::new(start_s, start_s + length_s).expect("times of a shutter are finite")
    }

    /// Returns the time from the beginning of the first row's exposure to the end of the last one's, s.
    #[must_use]
    pub fn length_s(&self, rows: usize, exposure_s: f64) -> f64 {
        match self {
            Self::Global => exposure_s,
            Self::Rolling(timing) | Self::GlobalReset(timing) => {
                exposure_s + timing.row_time_s * rows.saturating_sub(1) as f64
            }
        }
    }

    /// Returns a row's exposure time over the nominal one: 1 except for global reset.
    #[must_use]
    pub fn exposure_ratio(&self, row: usize, rows: usize, exposure_s: f64) -> f64 {
        match self {
            Self::Global | Self::Rolling(_) => 1.0,
            Self::GlobalReset(_) => self.exposure(row, rows, exposure_s).length_s() / exposure_s,
        }
    }

    /// Order in which rows are read; `None` if all end together.
    #[must_use]
    pub fn row_timing(&self) -> Option<&RowTiming> {
        match self {
            Self::Global => None,
            Self::Rolling(timing) | Self::GlobalReset(timing) => Some(timing),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn starts(timing: RowTiming, rows: usize) -> Vec<f64> {
        (0..rows).map(|row| Shutter::Rolling(timing).exposure(row, rows, 4.0).start_s()).collect()
    }

    #[test]
    fn rows_are_read_in_turn_from_either_side_or_in_fields() {
        let timing = RowTiming { row_time_s: 0.5, upwards: false, fields: 1 };
        assert_eq!(starts(timing, 4), [0.0, 0.5, 1.0, 1.5]);
        assert_eq!(starts(RowTiming { upwards: true, ..timing }, 4), [1.5, 1.0, 0.5, 0.0]);
        assert_eq!(starts(RowTiming { fields: 2, ..timing }, 5), [0.0, 1.5, 0.5, 2.0, 1.0]);
        assert_eq!(starts(RowTiming { fields: 2, upwards: true, ..timing }, 4), [1.5, 0.5, 1.0, 0.0]);
    }

    #[test]
    fn every_shutter_opens_at_0_and_ends_with_its_last_row() {
        let timing = RowTiming { row_time_s: 0.25, upwards: false, fields: 3 };
        for shutter in [Shutter::Global, Shutter::Rolling(timing), Shutter::GlobalReset(timing)] {
            let exposures: Vec<_> = (0..10).map(|row| shutter.exposure(row, 10, 2.0)).collect();
            let first = exposures.iter().map(TimeInterval::start_s).fold(f64::INFINITY, f64::min);
            let last = exposures.iter().map(TimeInterval::end_s).fold(0.0, f64::max);
            assert_eq!((first, last), (0.0, shutter.length_s(10, 2.0)));
        }
        let reset = Shutter::GlobalReset(RowTiming { fields: 1, ..timing });
        assert_eq!([0, 4].map(|row| reset.exposure_ratio(row, 5, 2.0)), [1.0, 1.5]);
    }
}
