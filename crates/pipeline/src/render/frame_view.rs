//! A frame of a camera for ground truth: its pose over time, and the exposure of its rows (in the first of several captures).

use crate::plan::{CameraBody, CameraPlan};
use etendue_core::{CameraPose, TimeInterval};

/// A frame of a camera.
#[derive(Clone, Copy, Debug)]
pub struct FrameView<'a> {
    pub camera: &'a CameraPlan,
    /// The frame, from 0.
    pub frame: u32,
}

impl<'a> FrameView<'a> {
    /// Lens and raster.
    pub(crate) fn body(&self) -> &'a CameraBody {
        &self.camera.body
    }

    /// Pose of the camera at a simulated time, s.
    pub(crate) fn pose_at(&self, time_s: f64) -> CameraPose {
        self.camera.path.at(time_s)
    }

    /// Interval from the start of the first row's exposure to the end of the last row's.
    #[must_use]
    pub fn interval(&self) -> TimeInterval {
        self.camera.timing.capture(self.frame, 0)
    }

    /// Simulated time, s, of the middle of the exposure of a row of the image.
    #[must_use]
    pub fn row_middle_s(&self, row: usize) -> f64 {
        self.camera.timing.row(self.frame, 0, row).middle_s()
    }

    /// Simulated time, s, at which the height `y_px` (raster) is seen: interpolated linearly between the middles of rows, and extrapolated beyond the
    /// outermost. In an interlaced image the rows are those of the field of `row`.
    #[must_use]
    pub fn middle_at_s(&self, y_px: f64, row: usize) -> f64 {
        let exposure = &self.camera.timing.exposure;
        let neighbours = exposure.shutter.row_timing().and_then(|_| exposure.neighbours(y_px, row));
        let Some((rows, fraction)) = neighbours else { return self.row_middle_s(row) };
        let [from_s, to_s] = rows.map(|row| self.row_middle_s(row));
        from_s + (to_s - from_s) * fraction
    }
}
