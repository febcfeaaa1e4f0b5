//! Angular response, exchange between pixels, and automatic exposure.

use crate::place::Placed;
use crate::reader::{list, number, percentile, record, vector};

record! {
    /// Automatic exposure and gain. Exposure time is used before gain.
    pub struct AutoExposure {
        /// Image percentile that is set to the target; 95 leaves a twentieth above it.
        required percentile: Placed<f64> = percentile();
        /// Target of the percentile, from black (0) to white (1).
        required target: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Exponent of the correction per frame. Default: 1.
        optional damping: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Shortest and longest exposure; "exposure_s" lies between.
        required exposure_limits_s: Placed<[f64; 2]> = vector::<2>(number("s").above(0.0));
        /// Smallest and largest analogue gain; "analogue_gain" lies between.
        required gain_limits: Placed<[f64; 2]> = vector::<2>(number("").above(0.0));
    }
}

record! {
    /// Response of the micro-lenses as a function of the angle between the chief ray and the sensor's normal.
    pub struct AngleResponse {
        /// Pairs of angle (degrees, increasing from 0) and response (0 … 1, first 1), linear in the squared angle.
        required table: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("").at_least(0.0)), 1);
        /// Distance from the sensor to the exit pupil. Default: the lens's; for pinhole, thin and calibrated lenses the focal length.
        optional exit_pupil_mm: Placed<f64> = number("mm").above(0.0);
    }
}

record! {
    /// Exchange between a pixel and its eight neighbours. The sum is conserved.
    pub struct Exchange {
        /// Fraction for each neighbour left and right.
        required horizontal: Placed<f64> = number("").at_least(0.0).at_most(0.25);
        /// Fraction for each neighbour above and below.
        required vertical: Placed<f64> = number("").at_least(0.0).at_most(0.25);
        /// Fraction for each diagonal neighbour. Default: 0.
        optional corner: Placed<f64> = number("").at_least(0.0).at_most(0.25);
    }
}
