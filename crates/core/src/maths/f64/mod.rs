//! Functions of one or two `f64`.
//!
//! `sin`, `cos`, `sin_cos`, `exp`, `ln`, `atan` and `atan2` are our own: errors below 1.5 units in the last place. The
//! others are those of the libm crate (errors below 1 unit, portable), as they are on no hot path.

mod circular;
mod exponential;
mod portable;
#[cfg(test)]
mod tests;

pub use circular::{atan, atan2, cos, sin, sin_cos};
pub use exponential::{exp, ln};
pub use portable::{acos, asin, cbrt, exp_m1, exp2, hypot, ln_1p, log2, log10, pow, tan};
