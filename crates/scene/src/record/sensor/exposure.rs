//! What light meets before it is counted, and what sets its time.

use crate::place::Placed;
use crate::reader::{list, number, percentile, record, vector};

record! {
    /// Exposure and gain that follow the picture. Time is used before gain.
    pub struct AutoExposure {
        /// Percentile of the picture that shall reach the target, above 1 and below 100: 95 lets a twentieth of the pixels
        /// lie above it.
        required percentile: Placed<f64> = percentile();
        /// Where that share shall end, as a share of the range from black to white, between 0 and 1.
        required target: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Exponent of the correction from frame to frame, above 0 and at most 1. Default: 1.
        optional damping: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Shortest and longest exposure, s; "exposure_s" of the first frame lies between.
        required exposure_limits_s: Placed<[f64; 2]> = vector::<2>(number("s").above(0.0));
        /// Smallest and largest analogue gain; "analogue_gain" of the first frame lies between.
        required gain_limits: Placed<[f64; 2]> = vector::<2>(number("").above(0.0));
    }
}

record! {
    /// Response of the micro-lenses over the angle between the chief ray and the sensor's normal.
    pub struct AngleResponse {
        /// Pairs of an angle, degrees, and the response there, 0 … 1; angles rise from 0, where it is 1; linear in the angle's square between them.
        required table: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("").at_least(0.0)), 1);
        /// Distance of the exit pupil, from which chief rays come, from the sensor, mm, above 0. Default: the lens's own, on the
        /// axis; of a pinhole, a thin lens and a calibrated camera its focal length.
        optional exit_pupil_mm: Placed<f64> = number("mm").above(0.0);
    }
}

record! {
    /// What a pixel gives to its eight neighbours. Sums are kept.
    pub struct Exchange {
        /// Share given to each neighbour left and right.
        required horizontal: Placed<f64> = number("").at_least(0.0).at_most(0.25);
        /// Share given to each neighbour above and below.
        required vertical: Placed<f64> = number("").at_least(0.0).at_most(0.25);
        /// Share given to each neighbour across a corner. Default: 0.
        optional corner: Placed<f64> = number("").at_least(0.0).at_most(0.25);
    }
}
