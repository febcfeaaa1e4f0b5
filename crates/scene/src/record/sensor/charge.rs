//! Charge in the pixels, and non-uniformity.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, integer, number, record, variants, words};

record! {
    /// Non-uniformity: fixed differences between pixels, equal in all frames. Spreads are standard deviations.
    pub struct NonUniformity {
        /// Seed of the unit: equal numbers give equal patterns. Default: one for each camera.
        optional seed: Placed<u64> = integer(0, 9_007_199_254_740_991);
        /// PRNU between pixels, as a fraction. Default: 0.
        optional prnu: Placed<f64> = spread();
        /// The same between rows. Default: 0.
        optional prnu_row: Placed<f64> = spread();
        /// The same between columns. Default: 0.
        optional prnu_column: Placed<f64> = spread();
        /// DSNU between pixels, at zero exposure. Default: 0.
        optional dsnu_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// The same between rows. Default: 0.
        optional dsnu_row_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// The same between columns. Default: 0.
        optional dsnu_column_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Fraction of pixels that hold no charge. Default: 0.
        optional dead_fraction: Placed<f64> = spread();
    }
}

fn spread() -> crate::reader::NumberRule {
    number("").at_least(0.0).at_most(1.0)
}

record! {
    /// Dark current by temperature and by pixel. All currents refer to "reference_c".
    pub struct Dark check(check_dark) {
        /// Temperature of the sensor. Default: that of the stated current.
        optional temperature_c: Placed<f64> = number("°C").above(-273.15);
        /// With "temperature_c": temperature of the stated current.
        optional reference_c: Placed<f64> = number("°C").above(-273.15);
        /// With "temperature_c": difference that doubles the current. Default: from silicon's band gap.
        optional doubling_k: Placed<f64> = number("K").above(0.0);
        /// With "temperature_c", without "doubling_k": fraction of diffusion current; the rest is generation current. Default: 0.
        optional diffusion_fraction: Placed<f64> = spread();
        /// Spread between pixels over the mean. Default: 0.
        optional spread: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// The same between rows. Default: 0.
        optional spread_row: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// The same between columns. Default: 0.
        optional spread_column: Placed<f64> = number("").at_least(0.0).at_most(10.0);
        /// Shape of the spread between pixels. Default: "normal".
        optional distribution: Placed<SpreadDistribution> = choice();
        /// Hot pixels.
        optional hot: HotPixels = record();
        /// Pixels with a two-level current.
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
    pub struct HotPixels {
        /// Fraction of pixels.
        required fraction: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Mean additional current (exponential).
        required mean_e_s: Placed<f64> = number("e⁻/s").above(0.0);
    }
}

record! {
    /// Blinking pixels.
    pub struct DarkCurrentRts {
        /// Fraction of pixels.
        required fraction: Placed<f64> = number("").above(0.0).at_most(1.0);
        /// Mean additional current at the upper level (exponential).
        required mean_e_s: Placed<f64> = number("e⁻/s").above(0.0);
        /// Mean number of frames at a level.
        required dwell_frames: Placed<f64> = number("").at_least(1.0);
    }
}

fn check_dark(dark: &Dark, errors: &mut DescriptionErrors) {
    let law = [&dark.reference_c, &dark.doubling_k, &dark.diffusion_fraction];
    match (&dark.temperature_c, &dark.reference_c) {
        (None, _) => {
            for key in law.into_iter().flatten() {
                errors.add(
                    ErrorCode::NoEffect,
                    &key.place,
                    "this key has no effect without \"temperature_c\"",
                    "add it, or remove this key",
                );
            }
        }
        (Some(temperature), None) => {
            errors.add(
                ErrorCode::MissingKey,
                &temperature.place,
                "the temperature of the stated current is missing",
                "add \"reference_c\"",
            );
        }
        (Some(_), Some(_)) => {}
    }
    if let (Some(_), Some(fraction)) = (&dark.doubling_k, &dark.diffusion_fraction) {
        errors.add(
            ErrorCode::NoEffect,
            &fraction.place,
            "\"diffusion_fraction\" has no effect with \"doubling_k\"",
            "remove one of the two",
        );
    }
    if let (Some(distribution), None) = (&dark.distribution, &dark.spread) {
        errors.add(
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
        /// Data-sheet smear for a spot of a tenth of the image's height.
        required smear_db: Placed<f64> = number("dB").at_least(-200.0).at_most(-20.0);
        /// Accumulation time over frame time of that measurement. Default: 1.
        optional measured_exposure_ratio: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

record! {
    /// Smear during the shift.
    pub struct FrameTransfer {
        /// Time of a shift by one row.
        required line_shift_s: Placed<f64> = number("s").above(0.0);
    }
}

record! {
    /// A kind of charge trap.
    pub struct Trap {
        /// Fraction of a frame's charge that is trapped.
        required fraction: Placed<f64> = number("").above(0.0).at_most(0.5);
        /// Time after which 1/e of the trapped charge is left.
        required time_constant_s: Placed<f64> = number("s").above(0.0);
    }
}

record! {
    /// Overflow into other pixels.
    pub struct Blooming {
        /// Direction of the overflow.
        required direction: Placed<Direction> = choice();
        /// Fraction of the excess that flows to other pixels; the rest is drained.
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
