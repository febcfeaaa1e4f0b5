//! Angular response, exchange between pixels, and automatic exposure.

use crate::place::Placed;
use crate::reader::{list, number, percentile, record, vector};

record! {
    /// Automatic exposure and gain. Exposure time is used before gain.
    pub struct AutoExposure {
        /// Percentile of the image that is set to the target, above 1 and below 100: 95 leaves a twentieth of the pixels above it.
        required percentile: Placed<f64> = percentile();
        /// Target of that percentile, as a fraction of the range from black to white, between 0 and 1.
        required target: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Exponent of the correction from frame to frame, above 0 and at most 1. Default: 1.
        optional damping: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Shortest and longest exposure, s; "exposure_s" of the first frame lies between them.
        required exposure_limits_s: Placed<[f64; 2]> = vector::<2>(number("s").above(0.0));
        /// Smallest and largest analogue gain; "analogue_gain" of the first frame lies between them.
        required gain_limits: Placed<[f64; 2]> = vector::<2>(number("").above(0.0));
    }
}

record! {
    /// Response of the micro-lenses as a function of the angle between the chief ray and the sensor's normal.
    pub struct AngleResponse {
        /// Pairs of an angle, degrees, and the response there, 0 … 1. Angles rise from 0, where the response is 1; linear in the square of the angle
        /// between the points.
        required table: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("").at_least(0.0)), 1);
        /// Distance from the sensor to the exit pupil, where chief rays originate, mm, above 0. Default: that of the lens on the axis; for a pinhole,
        /// a thin lens and a calibrated camera the focal length.
        optional exit_pupil_mm: Placed<f64> = number("mm").above(0.0);
    }
}

record! {
    /// Exchange between a pixel and its eight neighbours. The sum is conserved.
    pub struct Exchange {
        /// Fraction given to each neighbour left and right.
        required horizontal: Placed<f64> = number("").at_least(0.0).at_most(0.25);
        /// Fraction given to each neighbour above and below.
        required vertical: Placed<f64> = number("").at_least(0.0).at_most(0.25);
        /// Fraction given to each diagonal neighbour. Default: 0.
        optional corner: Placed<f64> = number("").at_least(0.0).at_most(0.25);
    }
}
