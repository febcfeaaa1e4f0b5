//! A frame of a camera as its ground truth knows it: where it stands when, and when its rows are exposed (in the first of several captures).

use crate::plan::{CameraBody, CameraPlan};
use etendue_core::{CameraPose, TimeInterval};

/// A frame of a camera.
#[derive(Clone, Copy, Debug)]
pub struct FrameView<'a> {
    /// The camera.
    pub camera: &'a CameraPlan,
    /// The frame, from 0.
    pub frame: u32,
}

impl<'a> FrameView<'a> {
    /// Lens and raster.
    pub(crate) fn body(&self) -> &'a CameraBody {
        &self.camera.body
    }

    /// Where the camera stands at a simulated time, s.
    pub(crate) fn pose_at(&self, time_s: f64) -> CameraPose {
        self.camera.path.at(time_s)
    }

    /// From the beginning of the first row's exposure to the end of the last one's.
    #[must_use]
    pub fn interval(&self) -> TimeInterval {
        self.camera.timing.capture(self.frame, 0)
    }

    /// The simulated time, s, at the middle of the exposure of a row of the picture.
    #[must_use]
    pub fn row_middle_s(&self, row: usize) -> f64 {
        self.camera.timing.row(self.frame, 0, row).middle_s()
    }

    /// The simulated time, s, at which a place at the height `y_px` (raster) is seen: between the middles of rows on a straight line, beyond those
    /// that are read on that of the outermost. Of an interlaced picture the rows are those of the field of `row`.
    #[must_use]
    pub fn middle_at_s(&self, y_px: f64, row: usize) -> f64 {
        let exposure = &self.camera.timing.exposure;
        let neighbours = exposure.shutter.row_timing().and_then(|_| exposure.neighbours(y_px, row));
        let Some((rows, share)) = neighbours else { return self.row_middle_s(row) };
        let [from_s, to_s] = rows.map(|row| self.row_middle_s(row));
        from_s + (to_s - from_s) * share
    }
}
