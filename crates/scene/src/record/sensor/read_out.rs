//! From charge to digital numbers.

use crate::place::Placed;
use crate::reader::{choice, list, number, record, variants, vector, whole, words};

variants! {
    /// Voltage over charge.
    pub enum Response by "type" {
        /// Straight lines of falling slopes.
        "knees" => Knees(Knees),
        /// Logarithmic above a charge.
        "logarithmic" => Logarithmic(Logarithmic),
    }
}

record! {
    /// Straight lines.
    pub struct Knees {
        /// Pairs of a charge, e⁻, and the slope above it, which falls from below 1; below the first it is 1.
        required knees: Vec<Placed<[f64; 2]>> = list(vector::<2>(number("").above(0.0)), 1);
    }
}

record! {
    /// A logarithm.
    pub struct Logarithmic {
        /// Charge above which it begins, e⁻, above 0.
        required from_e: Placed<f64> = number("e⁻").above(0.0);
    }
}

record! {
    /// Random RTS noise.
    pub struct RtsNoise {
        /// Share of pixels, above 0.
        required share: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Mean of their jumps (exponential), e⁻, above 0.
        required mean_e: Placed<f64> = number("e⁻").above(0.0);
        /// Mean number of frames at a level, 1 or more.
        required dwell_frames: Placed<f64> = number("").at_least(1.0);
    }
}

record! {
    /// Pixels that no light reaches.
    pub struct OpticalBlack {
        /// Rows above the picture. Default: 0.
        optional rows_px: Placed<u64> = whole(0, 4096);
        /// Columns left of the picture. Default: 0.
        optional columns_px: Placed<u64> = whole(0, 4096);
    }
}

record! {
    /// Pixels of the same colour that are read together.
    pub struct Binning {
        /// Pixels of a row.
        required columns: Placed<u64> = whole(1, 64);
        /// Pixels of a column.
        required rows: Placed<u64> = whole(1, 64);
        /// What is put together: "charge" is added before it is read, digital "numbers" are averaged.
        required of: Placed<BinningOf> = choice();
    }
}

record! {
    /// Pixels that are not read: of every `columns` × `rows` tiles of the filter array only the first is, in region and optical black alike.
    pub struct Skipping {
        /// Tiles beside each other of which one is read. Default: 1, no column is skipped.
        optional columns: Placed<u64> = whole(1, 64);
        /// Tiles below each other of which one is read; rows that are skipped take no time of a shutter that reads row after row.
        /// Default: 1, no row is skipped.
        optional rows: Placed<u64> = whole(1, 64);
    }
}

words! {
    /// What is put together.
    pub enum BinningOf {
        /// Charge is added before it is read: the read noise comes once.
        "charge" => Charge,
        /// Digital numbers are averaged.
        "numbers" => Numbers,
    }
}
