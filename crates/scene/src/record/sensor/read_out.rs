//! From charge to digital numbers.

use crate::place::Placed;
use crate::reader::{choice, integer, list, number, record, variants, vector, words};

variants! {
    /// Voltage as a function of charge.
    pub enum Response by "type" {
        /// Piecewise linear with falling slopes.
        "knees" => Knees(Knees),
        /// Logarithmic above a charge.
        "logarithmic" => Logarithmic(Logarithmic),
    }
}

record! {
    /// Piecewise linear response.
    pub struct Knees {
        /// Pairs of charge (e⁻) and the slope above it, falling from below 1.
        required knees: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("").above(0.0)), 1);
    }
}

record! {
    /// Logarithmic response.
    pub struct Logarithmic {
        /// Charge above which the response is logarithmic.
        required from_e: Placed<f64> = number("e⁻").above(0.0);
    }
}

record! {
    /// Random telegraph signal (RTS) noise.
    pub struct RtsNoise {
        /// Fraction of pixels.
        required fraction: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Mean size of the jumps (exponential).
        required mean_e: Placed<f64> = number("e⁻").above(0.0);
        /// Mean number of frames at a level.
        required dwell_frames: Placed<f64> = number("").at_least(1.0);
    }
}

record! {
    /// Optical black: pixels that receive no light.
    pub struct OpticalBlack {
        /// Rows above the image. Default: 0.
        optional rows_px: Placed<u64> = integer(0, 4096);
        /// Columns left of the image. Default: 0.
        optional columns_px: Placed<u64> = integer(0, 4096);
    }
}

record! {
    /// Pixels of the same colour that are read out together.
    pub struct Binning {
        /// Pixels in a row.
        required columns: Placed<u64> = integer(1, 64);
        /// Pixels in a column.
        required rows: Placed<u64> = integer(1, 64);
        /// "charge" is added before it is read; digital "numbers" are averaged.
        required of: Placed<BinnedQuantity> = choice();
    }
}

record! {
    /// Pixels that are not read out: of every `columns` × `rows` tiles of the filter array only the first is read, in the region and in optical
    /// black.
    pub struct Skipping {
        /// One of this many adjacent tiles in a row is read. Default: 1.
        optional columns: Placed<u64> = integer(1, 64);
        /// One of this many adjacent tiles in a column is read, which saves shutter time. Default: 1.
        optional rows: Placed<u64> = integer(1, 64);
    }
}

words! {
    /// The binned quantity.
    pub enum BinnedQuantity {
        /// Charge is added before it is read: read noise is added once.
        "charge" => Charge,
        /// Digital numbers are averaged.
        "numbers" => Numbers,
    }
}
