//! `[sequence]`: times of a job's frames.

use etendue_core::ExactTime;

use crate::place::Placed;
use crate::reader::{number, record, time};

record! {
    /// Times of a job's frames. Frame k begins at start_s + k / frame_rate_hz, for each camera later by its "trigger_offset_s". Without this table
    /// frame 0 begins at 0 s; other frames are refused where light changes between frames.
    pub struct Sequence {
        /// Frame rate; 1/"frame_period_s" of a sensor that states one.
        required frame_rate_hz: Placed<f64> = number("Hz").above(0.0);
        /// Simulated time of frame 0. Times are rounded as numbers (0.24 µs at 1.7·10⁹ s), exact as text. Default: 0.
        optional start_s: Placed<ExactTime> = time();
    }
}
