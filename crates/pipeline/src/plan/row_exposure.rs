//! Exposure times of the rows of a camera's captures, relative to the start of a frame.

use etendue_core::{Shutter, TimeInterval};

/// Exposure times of the rows of a camera's captures, relative to the start of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct RowExposure {
    /// The order of rows.
    pub shutter: Shutter,
    /// First row of the sensor that is read.
    pub first_row: usize,
    /// Number of rows that are read, at least 1.
    pub rows: usize,
    /// Rows between them that are skipped.
    pub skipping: RowSkipping,
    /// Exposure time, s; 0 for an instantaneous camera.
    pub exposure_s: f64,
    /// Captures of a frame, the first one at 0 s.
    pub captures: Vec<CaptureTiming>,
}

/// Exposure of a capture of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureTiming {
    /// Start, s after that of the first.
    pub start_s: f64,
    /// Exposure time over that of the first.
    pub exposure_ratio: f64,
}

/// Row skipping: of every `pitch` rows the first `together` are read, counted from the first row that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowSkipping {
    /// Number of adjacent rows that are read: those of a tile of the colour filter array; at least 1.
    pub together: usize,
    /// Distance from the first of them to the first of the next, rows; at least `together`.
    pub pitch: usize,
}

impl RowSkipping {
    /// All rows are read.
    pub const NONE: Self = Self { together: 1, pitch: 1 };

    /// Returns true if a row is skipped.
    #[must_use]
    pub fn skips(&self) -> bool {
        self.pitch > self.together
    }

    /// Position of the `rank`-th of the rows that are read.
    fn row_of(&self, rank: usize) -> usize {
        rank / self.together * self.pitch + rank % self.together
    }

    /// Number of rows that are read above `row`, if it is one of them; otherwise above the next one before it.
    fn rank_below(&self, row: usize) -> usize {
        row / self.pitch * self.together + (row % self.pitch).min(self.together - 1)
    }

    /// Rank, among `rows`, of the row that is read nearest to `row`; of two the upper one.
    fn nearest_rank(&self, row: usize, rows: usize) -> usize {
        let upper = self.rank_below(row).min(rows - 1);
        let lower = (upper + 1).min(rows - 1);
        let is_lower = self.row_of(lower).abs_diff(row) < self.row_of(upper).abs_diff(row);
        if is_lower { lower } else { upper }
    }
}

impl RowExposure {
    /// All rows simultaneously, in a single capture.
    #[must_use]
    pub fn global(rows: usize, exposure_s: f64) -> Self {
        let captures = vec![CaptureTiming { start_s: 0.0, exposure_ratio: 1.0 }];
        Self { shutter: Shutter::Global, first_row: 0, rows, skipping: RowSkipping::NONE, exposure_s, captures }
    }

    /// Exposure of a row of the sensor in a capture; a skipped row has that of the nearest row that is read.
    #[must_use]
    pub fn row(&self, capture: usize, row: usize) -> TimeInterval {
        let CaptureTiming { start_s, exposure_ratio } = self.captures[capture];
        self.shutter.exposure(self.rank(row), self.rows, self.exposure_s * exposure_ratio).later(start_s)
    }

    /// Interval from the start of the first row to the end of the last in a capture.
    #[must_use]
    pub fn capture(&self, capture: usize) -> TimeInterval {
        let CaptureTiming { start_s, exposure_ratio } = self.captures[capture];
        let length_s = self.shutter.length_s(self.rows, self.exposure_s * exposure_ratio);
        TimeInterval::new(start_s, start_s + length_s).expect("times of a camera are finite")
    }

    /// Time from the start of a row's first exposure to the end of its last, for the row with the longest, s.
    #[must_use]
    pub fn longest_row_s(&self) -> f64 {
        let end = |capture: usize| {
            let CaptureTiming { start_s, exposure_ratio } = self.captures[capture];
            let exposure_s = self.exposure_s * exposure_ratio;
            start_s + if self.is_even() { exposure_s } else { self.shutter.length_s(self.rows, exposure_s) }
        };
        (0..self.captures.len()).map(end).fold(0.0, f64::max)
    }

    /// Readout time of all rows one after the other, s; 0 if all end simultaneously.
    #[must_use]
    pub fn reading_s(&self) -> f64 {
        self.shutter.row_timing().map_or(0.0, |rows| rows.row_time_s * self.rows as f64)
    }

    /// Light of a row relative to the stated exposure time: 1 except for global reset.
    #[must_use]
    pub fn exposure_ratio(&self, capture: usize, row: usize) -> f64 {
        let exposure_s = self.exposure_s * self.captures[capture].exposure_ratio;
        if exposure_s > 0.0 { self.shutter.exposure_ratio(self.rank(row), self.rows, exposure_s) } else { 1.0 }
    }

    /// Captures whose exposure differs from that of every earlier capture, in order; includes the first.
    #[must_use]
    pub fn distinct_captures(&self) -> Vec<usize> {
        let is_new = |capture: &usize| !self.captures[..*capture].contains(&self.captures[*capture]);
        (0..self.captures.len()).filter(is_new).collect()
    }

    /// Returns true if all rows start and end simultaneously.
    #[must_use]
    pub fn is_global(&self) -> bool {
        self.shutter.row_timing().is_none_or(|rows| rows.row_time_s == 0.0)
    }

    /// Returns true if all rows have the same exposure time.
    #[must_use]
    pub fn is_even(&self) -> bool {
        !matches!(self.shutter, Shutter::GlobalReset(_)) || self.is_global()
    }

    /// Number of rows that are read above `row`; for a skipped row, the rank of the nearest row that is read.
    fn rank(&self, row: usize) -> usize {
        self.skipping.nearest_rank(row.saturating_sub(self.first_row), self.rows)
    }

    /// The two neighbouring rows of one field that are used to interpolate or extrapolate at the height `y_px` (raster), and the position between them: 0 at
    /// the first, 1 at the second. The field is that of `row`; `None` if it has a single row.
    #[must_use]
    pub fn neighbours(&self, y_px: f64, row: usize) -> Option<([usize; 2], f64)> {
        let fields = self.shutter.row_timing().map_or(1, |timing| timing.fields.max(1) as usize);
        let field = self.rank(row) % fields;
        let steps = (self.rows - 1 - field) / fields;
        let row_of = |step: usize| self.first_row + self.skipping.row_of(field + fields * step);
        let last = steps.checked_sub(1)?;
        let place = y_px - 0.5 - self.first_row as f64;
        let step = if self.skipping.skips() {
            self.skipping.rank_below(place.max(0.0) as usize).saturating_sub(field) / fields
        } else {
            ((place - field as f64) / fields as f64).floor().max(0.0) as usize
        };
        let [from, to] = [0, 1].map(|next| row_of(step.min(last) + next));
        Some(([from, to], (y_px - 0.5 - from as f64) / (to - from) as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::RowTiming;

    fn rolling(skipping: RowSkipping, fields: u32, upwards: bool) -> RowExposure {
        let shutter = Shutter::Rolling(RowTiming { row_time_s: 1.0, upwards, fields });
        RowExposure { shutter, first_row: 2, skipping, ..RowExposure::global(6, 0.5) }
    }

    /// Two of every six rows are read: 2, 3, 8, 9, 14, 15 of the sensor are the six of the image.
    #[test]
    fn rows_that_are_skipped_take_no_time() {
        let pairs = RowSkipping { together: 2, pitch: 6 };
        let starts = |exposure: &RowExposure, rows: &[usize]| -> Vec<f64> {
            rows.iter().map(|row| exposure.row(0, *row).start_s()).collect()
        };
        let read = [2, 3, 8, 9, 14, 15];
        assert_eq!(starts(&rolling(pairs, 1, false), &read), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(starts(&rolling(pairs, 1, true), &read), [5.0, 4.0, 3.0, 2.0, 1.0, 0.0]);
        assert_eq!(starts(&rolling(pairs, 2, false), &read), [0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
        // Skipped rows have the exposure of the nearest row, those outside that of the outermost.
        assert_eq!(
            starts(&rolling(pairs, 1, false), &[0, 4, 5, 6, 7, 13, 16, 99]),
            [0.0, 1.0, 1.0, 2.0, 2.0, 4.0, 5.0, 5.0]
        );
        let exposure = rolling(pairs, 1, false);
        assert_eq!((exposure.reading_s(), exposure.capture(0).end_s()), (6.0, 5.5));
    }

    #[test]
    fn global_reset_counts_the_rows_that_are_read() {
        let rows = RowTiming { row_time_s: 1.0, upwards: false, fields: 1 };
        let skipping = RowSkipping { together: 1, pitch: 4 };
        let exposure = RowExposure { shutter: Shutter::GlobalReset(rows), skipping, ..RowExposure::global(3, 2.0) };
        assert_eq!([0, 4, 8].map(|row| exposure.exposure_ratio(0, row)), [1.0, 1.5, 2.0]);
    }

    #[test]
    fn heights_lie_between_the_rows_that_are_read() {
        let of = |skipping, fields, y_px, row| rolling(skipping, fields, false).neighbours(y_px, row);
        assert_eq!(of(RowSkipping::NONE, 1, 4.75, 2), Some(([4, 5], 0.25)));
        assert_eq!(of(RowSkipping::NONE, 2, 4.75, 3), Some(([3, 5], 0.625)));
        let pairs = RowSkipping { together: 2, pitch: 6 };
        assert_eq!(of(pairs, 1, 2.75, 2), Some(([2, 3], 0.25)));
        assert_eq!(of(pairs, 1, 6.0, 2), Some(([3, 8], 0.5)));
        assert_eq!(of(pairs, 2, 5.5, 8), Some(([2, 8], 0.5)));
        assert_eq!(of(pairs, 2, 5.0, 9), Some(([3, 9], 0.25)));
        for (y_px, ends) in [(0.5, [2, 3]), (17.5, [14, 15])] {
            assert_eq!(of(pairs, 1, y_px, 2).expect("two rows").0, ends, "beyond on their straight line");
        }
        assert_eq!(rolling(pairs, 6, false).neighbours(4.0, 2), None);
    }
}
