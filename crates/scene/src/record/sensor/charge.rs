//! Charge in the pixels, and non-uniformity.

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{choice, number, record, variants, whole, words};

record! {
    /// Non-uniformity: fixed differences between pixels, equal in all frames. Spreads are standard deviations.
    pub struct NonUniformity {
        /// Seed of the unit (the individual sensor): the same number gives the same pattern. Default: a seed for each camera of a job.
        optional seed: Placed<u64> = whole(0, 9_007_199_254_740_991);
        /// Spread of the response to light between pixels, as a fraction (PRNU). Default: 0.
        optional prnu: Placed<f64> = spread();
        /// The same between rows. Default: 0.
        optional prnu_row: Placed<f64> = spread();
        /// The same between columns. Default: 0.
        optional prnu_column: Placed<f64> = spread();
        /// Spread of the offset between pixels, e⁻ (DSNU at zero exposure time). Default: 0.
        optional dsnu_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// The same between rows. Default: 0.
        optional dsnu_row_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// The same between columns. Default: 0.
        optional dsnu_column_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Fraction of pixels that hold no charge. Default: 0.
        optional dead_fraction: Placed<f64> = spread();
    }
}

fn spread() -> crate::reader::Number {
    number("").at_least(0.0).at_most(1.0)
}

record! {
    /// Dark current by temperature and by pixel. All currents refer to "reference_c".
    pub struct Dark check(check_dark) {
        /// Temperature of the sensor, °C, above absolute zero. Default: that of the stated current.
        optional temperature_c: Placed<f64> = number("°C").above(-273.15);
        /// Temperature of the stated current, °C; with "temperature_c".
        optional reference_c: Placed<f64> = number("°C").above(-273.15);
        /// Temperature difference that doubles the current, K; with "temperature_c". Default: from the band gap of silicon.
        optional doubling_k: Placed<f64> = number("K").above(0.0);
        /// With "temperature_c" and without "doubling_k": fraction of the stated current that is diffusion current, 0 … 1; the rest is generation
        /// current. Default: 0.
        optional diffusion_fraction: Placed<f64> = spread();
        /// Spread of the current between pixels, as a fraction of its mean, 0 … 10. Default: 0.
        optional spread: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// The same between rows. Default: 0.
        optional spread_row: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// The same between columns. Default: 0.
        optional spread_column: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// Shape of the spread between pixels. Default: "normal".
        optional distribution: Placed<SpreadDistribution> = choice();
        /// Hot pixels, with much more current. Default: none.
        optional hot: Hot = record();
        /// Pixels whose current jumps between two levels. Default: none.
        optional dark_current_rts: DarkCurrentRts = record();
    }
}

words! {
    /// Shape of a distribution.
    pub enum SpreadDistribution {
        /// Normal, truncated at 0.
        "normal" => Normal,
        /// Log-normal with the same mean and spread.
        "log_normal" => LogNormal,
    }
}

record! {
    /// Hot pixels.
    pub struct Hot {
        /// Fraction of pixels, above 0.
        required share: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Mean of their additional current (exponential), e⁻/s, above 0.
        required mean_e_s: Placed<f64> = number("e⁻/s").above(0.0);
    }
}

record! {
    /// Blinking pixels.
    pub struct DarkCurrentRts {
        /// Fraction of pixels, above 0.
        required share: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Mean of their additional current at the upper level (exponential), e⁻/s, above 0.
        required mean_e_s: Placed<f64> = number("e⁻/s").above(0.0);
        /// Mean number of frames at a level, 1 or more.
        required dwell_frames: Placed<f64> = number("").at_least(1.0);
    }
}

fn check_dark(dark: &Dark, faults: &mut Faults) {
    let law = [&dark.reference_c, &dark.doubling_k, &dark.diffusion_fraction];
    match (&dark.temperature_c, &dark.reference_c) {
        (None, _) => {
            for key in law.into_iter().flatten() {
                faults.add(
                    ErrorCode::NoEffect,
                    &key.place,
                    "this key has no effect without \"temperature_c\"",
                    "add it, or remove this key",
                );
            }
        }
        (Some(temperature), None) => {
            faults.add(
                ErrorCode::MissingKey,
                &temperature.place,
                "the temperature of the stated current is missing",
                "add \"reference_c\"",
            );
        }
        (Some(_), Some(_)) => {}
    }
    if let (Some(_), Some(share)) = (&dark.doubling_k, &dark.diffusion_fraction) {
        faults.add(
            ErrorCode::NoEffect,
            &share.place,
            "\"diffusion_fraction\" has no effect with \"doubling_k\"",
            "remove one of the two",
        );
    }
    if let (Some(distribution), None) = (&dark.distribution, &dark.spread) {
        faults.add(
            ErrorCode::NoEffect,
            &distribution.place,
            "\"distribution\" has no effect without \"spread\"",
            "add it, or remove this key",
        );
    }
}

variants! {
    /// Smear of a CCD.
    pub enum Smear by "type" {
        /// Charge moves down a covered register next to the pixels.
        "interline" => Interline(Interline),
        /// Charge moves fast through the pixels themselves.
        "frame_transfer" => FrameTransfer(FrameTransfer),
    }
}

record! {
    /// Smear by light that leaks through the register's cover.
    pub struct Interline {
        /// Smear of the data sheet for a spot of a tenth of the image's height, dB, −200 … −20.
        required smear_db: Placed<f64> = number("dB").at_least(-200.0).at_most(-20.0);
        /// Accumulation time over frame time in the data sheet's measurement, above 0 and at most 1. Default: 1.
        optional measured_exposure_ratio: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

record! {
    /// Smear during the shift.
    pub struct FrameTransfer {
        /// Time of a shift by one row, s, above 0.
        required line_shift_s: Placed<f64> = number("s").above(0.0);
    }
}

record! {
    /// A kind of charge trap.
    pub struct Trap {
        /// Fraction of a frame's charge that is trapped, above 0.
        required share: Placed<f64> = number("").above(0.0).at_most(0.5);
        /// Time after which 1/e of the trapped charge is left, s, above 0.
        required time_constant_s: Placed<f64> = number("s").above(0.0);
    }
}

record! {
    /// Overflow into other pixels.
    pub struct Blooming {
        /// Direction of the overflow.
        required direction: Placed<Direction> = choice();
        /// Fraction of the excess charge that flows to other pixels, above 0; the rest is drained.
        required overflow_fraction: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

words! {
    /// Direction of the overflow.
    pub enum Direction {
        /// Half up and half down the column: a CCD.
        "column" => Column,
        /// To all sides: a CMOS sensor; "overflow_fraction" is at most 0.95.
        "around" => Around,
    }
}
