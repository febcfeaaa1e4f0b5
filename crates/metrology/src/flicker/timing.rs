//! The times of rows and frames.

/// When rows and frames were exposed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlickerTiming {
    /// From one row of the images to the next, s; `None` where all rows are exposed together.
    pub row_time_s: Option<f64>,
    /// Frames a second; `None` where it is not known.
    pub frame_rate_hz: Option<f64>,
    /// How long each row is exposed, s; `None` where it is not known.
    pub exposure_s: Option<f64>,
}
