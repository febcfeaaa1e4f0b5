//! Estimators, confidence, hypothesis tests and error metrics.
//!
//! | module | content |
//! | --- | --- |
//! | [`special`] | Γ, erf, incomplete Γ and B |
//! | [`normal`], [`student`], [`chi_square`] | distribution functions, p-values, critical values |
//! | [`sidak_level`](chi_square::sidak_level) | multiple tests (Šidák) |
//! | [`upper_median`] | median |
//! | [`moments`] | mean and variance of a stream of numbers (Welford) |
//! | [`ReplicateEstimate`] | mean and unbiased variance of randomised quasi-Monte Carlo |
//! | [`planes`] | test whether two estimated images differ |
//! | [`error`] | error metrics of two images |
//!
//! All in `f64`, summed in the order given, with the functions of `etendue_core::maths`: bit-identical on all platforms. The
//! crate is independent of the meaning of the numbers.

pub mod chi_square;
pub mod error;
pub mod moments;
pub mod normal;
pub mod planes;
pub mod special;
pub mod student;

pub use error::ErrorSummary;
pub use moments::{Moments, ReplicateEstimate, upper_median};
pub use planes::{EstimatedPlane, PlaneTest, Verdict};
