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
//! Nanoseconds a call, independent arguments, on an AMD EPYC (Zen) core, against libm and the platform:
//!
//! TIMING

mod kernel;

pub mod f32;
pub mod f64;
