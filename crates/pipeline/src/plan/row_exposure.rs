//! When the rows of a camera's captures are exposed, counted from the beginning of a frame.

use etendue_core::{Shutter, TimeInterval};

/// When the rows of a camera's captures are exposed, counted from the beginning of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct RowExposure {
    /// The order of rows.
    pub shutter: Shutter,
    /// The first row of the picture that is read.
    pub first_row: usize,
    /// Rows that are read, at least 1.
    pub rows: usize,
    /// Exposure time, s; 0 for a camera that sees one moment.
    pub exposure_s: f64,
    /// The exposures of a frame, the first one at 0 s.
    pub captures: Vec<CaptureTiming>,
}

/// When a capture of a frame is exposed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureTiming {
    /// Its beginning, s after that of the first.
    pub start_s: f64,
    /// Its exposure time over that of the first.
    pub exposure_ratio: f64,
}

impl RowExposure {
    /// All rows together, once.
    #[must_use]
    pub fn global(rows: usize, exposure_s: f64) -> Self {
        let captures = vec![CaptureTiming { start_s: 0.0, exposure_ratio: 1.0 }];
        Self { shutter: Shutter::Global, first_row: 0, rows, exposure_s, captures }
    }

    /// The exposure of a row of the picture in a capture; rows beyond those that are read have that of the nearest.
    #[must_use]
    pub fn row(&self, capture: usize, row: usize) -> TimeInterval {
        let CaptureTiming { start_s, exposure_ratio } = self.captures[capture];
        self.shutter.exposure(self.read_row(row), self.rows, self.exposure_s * exposure_ratio).later(start_s)
    }

    /// From the first row's beginning to the last one's end in a capture.
    #[must_use]
    pub fn capture(&self, capture: usize) -> TimeInterval {
        let CaptureTiming { start_s, exposure_ratio } = self.captures[capture];
        let length_s = self.shutter.length_s(self.rows, self.exposure_s * exposure_ratio);
        TimeInterval::new(start_s, start_s + length_s).expect("times of a camera are finite")
    }

    /// From the beginning of a row's first exposure to the end of its last, of the row that takes longest, s.
    #[must_use]
    pub fn longest_row_s(&self) -> f64 {
        let end = |capture: usize| {
            let CaptureTiming { start_s, exposure_ratio } = self.captures[capture];
            let exposure_s = self.exposure_s * exposure_ratio;
            start_s + if self.is_even() { exposure_s } else { self.shutter.length_s(self.rows, exposure_s) }
        };
        (0..self.captures.len()).map(end).fold(0.0, f64::max)
    }

    /// How long it takes to read all rows one after the other, s; 0 where all end together.
    #[must_use]
    pub fn reading_s(&self) -> f64 {
        self.shutter.row_timing().map_or(0.0, |rows| rows.row_time_s * self.rows as f64)
    }

    /// Light of a row over that of the stated exposure time: 1 but for global reset.
    #[must_use]
    pub fn exposure_ratio(&self, capture: usize, row: usize) -> f64 {
        let exposure_s = self.exposure_s * self.captures[capture].exposure_ratio;
        if exposure_s > 0.0 { self.shutter.exposure_ratio(self.read_row(row), self.rows, exposure_s) } else { 1.0 }
    }

    /// The captures whose exposure differs from that of every capture before them, in their order; the first is among them.
    #[must_use]
    pub fn distinct_captures(&self) -> Vec<usize> {
        let is_new = |capture: &usize| !self.captures[..*capture].contains(&self.captures[*capture]);
        (0..self.captures.len()).filter(is_new).collect()
    }

    /// Whether all rows begin and end together.
    #[must_use]
    pub fn is_global(&self) -> bool {
        self.shutter.row_timing().is_none_or(|rows| rows.row_time_s == 0.0)
    }

    /// Whether all rows are exposed as long.
    #[must_use]
    pub fn is_even(&self) -> bool {
        !matches!(self.shutter, Shutter::GlobalReset(_)) || self.is_global()
    }

    fn read_row(&self, row: usize) -> usize {
        row.clamp(self.first_row, self.first_row + self.rows - 1) - self.first_row
    }
}
