//! Functions of one or two `f32`.
//!
//! Series in double precision, rounded once: the error is at most 0.51 units in the last place, over the whole range
//! and into the subnormal numbers.

mod circular;
mod exponential;
#[cfg(test)]
mod tests;

pub use circular::{acos, asin, atan, atan2, cos, sin, sin_cos, tan};
pub use exponential::{cbrt, exp, exp_m1, exp2, hypot, ln, ln_1p, log2, log10, pow};

/// A function of libm where our own series do not hold; out of the way of the ordinary arguments.
#[cold]
#[inline(never)]
fn special(f: impl Fn(f64) -> f64, x: f32) -> f32 {
    f(f64::from(x)) as f32
}
