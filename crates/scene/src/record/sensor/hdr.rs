//! Several captures per frame, and companding.

use crate::place::Placed;
use crate::reader::{flag, integer, list, number, record, vector};

record! {
    /// Several captures per frame, merged: each pixel takes the first that is not saturated.
    pub struct Hdr {
        /// Captures after the first, by decreasing sensitivity.
        required captures: Vec<Capture> = list(record(), 1);
        /// Bits of the merged number, at least the ADC's.
        required merged_bits: Placed<u64> = integer(1, 24);
        /// Fraction of a capture's range above which the next is used. Default: 0.9.
        optional transition_level: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

record! {
    /// A capture, relative to the first.
    pub struct Capture {
        /// Exposure over that of the first. Default: 1.
        optional exposure_ratio: Placed<f64> = fraction();
        /// Start after that of the first. Default: the end of the photodiode's previous exposure, or the first's start.
        optional start_s: Placed<f64> = number("s").at_least(0.0);
        /// Photodiode sensitivity over that of the first (split pixel). Default: 1.
        optional sensitivity_ratio: Placed<f64> = fraction();
        /// Conversion gain over that of the first. Default: 1.
        optional gain_ratio: Placed<f64> = fraction();
        /// Full well. Default: the first's.
        optional full_well_e: Placed<f64> = number("e⁻").above(0.0);
        /// Read noise. Default: the first's.
        optional read_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Dual conversion gain: reads the previous capture's charge again. Default: false.
        optional dual_conversion_gain: Placed<bool> = flag();
    }
}

fn fraction() -> crate::reader::NumberRule {
    number("").above(0.0).at_most(1.0)
}

record! {
    /// Piecewise linear compression to fewer bits, from (0, 0).
    pub struct Companding {
        /// Bits of the companded number.
        required bits: Placed<u64> = integer(1, 24);
        /// Ends of segments: increasing linear and companded numbers, to the largest linear number; slopes decrease from at most 1.
        required knees: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("DN").above(0.0)), 1);
    }
}
