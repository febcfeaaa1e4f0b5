//! A frame of a camera as its ground truth knows it: where it stands when, and when its rows are exposed.

use crate::plan::CameraBody;
use etendue_core::{CameraPath, Shutter, TimeInterval};

/// A frame of a camera.
#[derive(Clone, Copy, Debug)]
pub struct FrameView<'a> {
    /// The camera.
    pub body: &'a CameraBody,
    /// Where it stands over time.
    pub path: &'a CameraPath,
    /// How its rows are exposed.
    pub shutter: &'a Shutter,
    /// The described exposure time, s.
    pub exposure_s: f64,
    /// When the first row begins its exposure, simulated time, s.
    pub start_s: f64,
}

impl FrameView<'_> {
    /// From the beginning of the first row's exposure to the end of the last one's.
    #[must_use]
    pub fn interval(&self) -> TimeInterval {
        let length_s = self.shutter.length_s(self.rows(), self.exposure_s);
        TimeInterval::new(self.start_s, self.start_s + length_s).expect("times of a frame are finite")
    }

    /// The simulated time, s, at the middle of the exposure of a row of the picture.
    #[must_use]
    pub fn row_middle_s(&self, row: usize) -> f64 {
        self.start_s + self.shutter.exposure(row, self.rows(), self.exposure_s).middle_s()
    }

    /// The simulated time, s, at which a place at the height `y_px` (raster) is seen: between the middles of rows on a straight line, beyond the
    /// picture on that of its outermost rows. Of an interlaced picture the rows are those of the field of `row`.
    #[must_use]
    pub fn middle_at_s(&self, y_px: f64, row: usize) -> f64 {
        let pitch = self.shutter.row_timing().map_or(1, |timing| timing.fields.max(1) as usize);
        let first = row % pitch;
        let Some(last) = (self.rows() - 1).checked_sub(first).map(|rest| rest / pitch).filter(|last| *last > 0) else {
            return self.row_middle_s(row);
        };
        // Rows of the field, counted from its first.
        let place = (y_px - 0.5 - first as f64) / pitch as f64;
        let low = place.floor().clamp(0.0, (last - 1) as f64);
        let [from_s, to_s] = [0, 1].map(|next| self.row_middle_s(first + pitch * (low as usize + next)));
        from_s + (to_s - from_s) * (place - low)
    }

    fn rows(&self) -> usize {
        self.body.raster.height()
    }
}
