//! Transcendental functions with the same bits on every machine.
//!
//! `+ − × ÷ sqrt` are exact everywhere and stay with the standard library; what the platform's library computes
//! differently from machine to machine is computed here: plain products and sums in a fixed order, never fused.
//!
//! [`f32`](mod@f32) evaluates short series in double precision and rounds once, so its results are the correctly
//! rounded ones but for about one in a hundred. [`f64`](mod@f64) carries low parts where they matter and stays within
//! 2 units in the last place; its rarely used functions are those of the libm crate, which is portable as well.
//! Arguments that are special (infinite, NaN, zero where it matters, or enormous angles) go to libm too.
//!
//! Nanoseconds a call for random arguments, call and loop included (an empty one takes 3), on an AMD EPYC core:
//!
//! | | f32 | libm | std | f64 | libm | std |
//! | --- | --- | --- | --- | --- | --- | --- |
//! | sin | 6 | 13 | 10 | 12 | 16 | 17 |
//! | sin_cos | 8 | 16 | 10 | 12 | 18 | 23 |
//! | tan | 7 | 8 | 13 | | | |
//! | asin | 9 | 10 | 10 | | | |
//! | atan2 | 7 | 16 | 19 | 14 | 18 | 12 |
//! | exp | 4 | 6 | 3 | 5 | 8 | 3 |
//! | exp_m1 | 4 | 13 | 13 | | | |
//! | ln | 5 | 5 | 3 | 7 | 6 | 3 |
//! | pow | 13 | 33 | 4 | | | |

mod kernel;

pub mod f32;
pub mod f64;
pub mod integer;
