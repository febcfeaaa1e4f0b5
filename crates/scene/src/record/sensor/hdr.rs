//! Several captures of a frame, and fewer bits.

use crate::place::Placed;
use crate::reader::{flag, list, number, record, vector, whole};

record! {
    /// Several captures of a frame, merged: of each pixel the first that is not saturated.
    pub struct Hdr {
        /// The captures after the one that the sensor's keys describe, by falling sensitivity.
        required captures: Vec<Capture> = list(record(), 1);
        /// Bits of the merged number, those of the converter … 24.
        required merged_bits: Placed<u64> = whole(1, 24);
        /// Share of a capture's range above which the next is taken, between 0 and 1. Default: 0.9.
        optional transition_level: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

record! {
    /// A capture, relative to the first.
    pub struct Capture {
        /// Its exposure over the first's, above 0 and at most 1. Default: 1.
        optional exposure_ratio: Placed<f64> = share();
        /// When its exposure begins, s after that of the first, 0 or more. Default: when the exposure
        /// before it of the same photodiode (of one "sensitivity_ratio") ends, with the first where there is none. Matters where light changes
        /// meanwhile.
        optional start_s: Placed<f64> = number("s").at_least(0.0);
        /// Its photodiode's sensitivity over the first's (split pixel), above 0 and at most 1. Default: 1.
        optional sensitivity_ratio: Placed<f64> = share();
        /// Its conversion gain over the first's, above 0 and at most 1. Default: 1.
        optional gain_ratio: Placed<f64> = share();
        /// Its full well, e⁻, above 0. Default: the first's.
        optional full_well_e: Placed<f64> = number("e⁻").above(0.0);
        /// Its read noise, e⁻, 0 or more. Default: the first's.
        optional read_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Whether it reads the charge of the capture before it once more (dual conversion gain). Default: false.
        optional dual_conversion_gain: Placed<bool> = flag();
    }
}

fn share() -> crate::reader::Number {
    number("").above(0.0).at_most(1.0)
}

record! {
    /// Fewer bits by straight lines from (0, 0).
    pub struct Companding {
        /// Bits of the companded number, 1 … 24.
        required bits: Placed<u64> = whole(1, 24);
        /// Ends of the lines: pairs of a linear and a companded number; both rise, slopes fall from at most 1. The last
        /// reaches the largest linear number.
        required knees: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("DN").above(0.0)), 1);
    }
}
