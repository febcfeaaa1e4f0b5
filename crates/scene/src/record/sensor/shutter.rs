//! Timing of the exposure of a sensor's rows.

use crate::place::Placed;
use crate::reader::{choice, integer, number, record, variants, words};

variants! {
    /// Timing of the exposure of a sensor's rows. In a static scene only "global_reset" changes the image.
    pub enum Shutter by "type" {
        /// All rows together.
        "global" => Global(Global),
        /// One row after the other, each for the whole exposure.
        "rolling" => Rolling(Rows),
        /// All rows start together and are read in sequence; later rows are exposed longer.
        "global_reset" => GlobalReset(Rows),
    }
}

record! {
    /// A shutter that exposes all rows together.
    pub struct Global {
        /// Exposure time without electronics. Default: 0.
        optional exposure_s: Placed<f64> = number("s").at_least(0.0);
    }
}

record! {
    /// A shutter whose rows are read in turn. Only rows that are read take time: those of a region ("roi_px"), without those that "skipping" leaves
    /// out.
    pub struct Rows {
        /// Time between rows.
        required row_time_us: Placed<f64> = number("µs").at_least(0.0);
        /// Read-out direction in the erect image. Default: "down".
        optional direction: Placed<Direction> = choice();
        /// Fields of a frame; with 2, even rows (from 0) are read before odd ones. Default: 1.
        optional fields: Placed<u64> = integer(1, 16);
        /// Exposure time without electronics. Default: 0.
        optional exposure_s: Placed<f64> = number("s").at_least(0.0);
    }
}

words! {
    /// Direction of the read-out.
    pub enum Direction {
        /// The top row of the image first.
        "down" => Down,
        /// The bottom row of the image first.
        "up" => Up,
    }
}

impl Shutter {
    /// Time from one row to the next; `None` where all rows are exposed together.
    #[must_use]
    pub fn row_time_us(&self) -> Option<&Placed<f64>> {
        match self {
            Self::Global(_) => None,
            Self::Rolling(rows) | Self::GlobalReset(rows) => Some(&rows.row_time_us),
        }
    }

    /// Exposure time of a sensor without electronics, if given.
    #[must_use]
    pub fn exposure_s(&self) -> Option<&Placed<f64>> {
        match self {
            Self::Global(shutter) => shutter.exposure_s.as_ref(),
            Self::Rolling(rows) | Self::GlobalReset(rows) => rows.exposure_s.as_ref(),
        }
    }
}
