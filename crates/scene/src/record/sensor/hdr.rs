//! Several captures per frame, and companding.

use crate::place::Placed;
use crate::reader::{flag, list, number, record, vector, whole};

record! {
    /// Several captures per frame, merged: each pixel takes the first that is not saturated.
    pub struct Hdr {
        /// Captures after the one that the sensor's keys describe, by falling sensitivity.
        required captures: Vec<Capture> = list(record(), 1);
        /// Bits of the merged number, from those of the ADC … 24.
        required merged_bits: Placed<u64> = whole(1, 24);
        /// Fraction of a capture's range above which the next capture is used, between 0 and 1. Default: 0.9.
        optional transition_level: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

record! {
    /// A capture, relative to the first.
    pub struct Capture {
        /// Exposure over that of the first, above 0 and at most 1. Default: 1.
        optional exposure_ratio: Placed<f64> = share();
        /// Start of the exposure after that of the first, s, 0 or more. It matters where light varies in time. Default: the end of the previous
        /// exposure of the same photodiode (of equal "sensitivity_ratio"), or the first's start where there is none.
        optional start_s: Placed<f64> = number("s").at_least(0.0);
        /// Sensitivity of the photodiode over that of the first (split pixel), above 0 and at most 1. Default: 1.
        optional sensitivity_ratio: Placed<f64> = share();
        /// Conversion gain over that of the first, above 0 and at most 1. Default: 1.
        optional gain_ratio: Placed<f64> = share();
        /// Full well, e⁻, above 0. Default: the first's.
        optional full_well_e: Placed<f64> = number("e⁻").above(0.0);
        /// Read noise, e⁻, 0 or more. Default: the first's.
        optional read_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Dual conversion gain: reads the charge of the previous capture again. Default: false.
        optional dual_conversion_gain: Placed<bool> = flag();
    }
}

fn share() -> crate::reader::Number {
    number("").above(0.0).at_most(1.0)
}

record! {
    /// Piecewise linear compression to fewer bits, from (0, 0).
    pub struct Companding {
        /// Bits of the companded number, 1 … 24.
        required bits: Placed<u64> = whole(1, 24);
        /// Ends of the segments: pairs of a linear and a companded number. Both rise; slopes fall from at most 1. The last reaches the largest linear
        /// number.
        required knees: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("DN").above(0.0)), 1);
    }
}
