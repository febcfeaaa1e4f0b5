//! Estimators, confidence, hypothesis tests and error metrics.
//!
//! | module | answers |
//! | --- | --- |
//! | [`special`] | Γ, erf, incomplete Γ and B |
//! | [`normal`], [`student`], [`chi_square`] | distribution functions, p-values, critical values |
//! | [`sidak_level`](chi_square::sidak_level) | many tests at once (Šidák) |
//! | [`upper_median`] | the middle of numbers |
//! | [`moments`] | mean and variance of a stream of numbers (Welford) |
//! | [`ReplicateEstimate`] | mean and honest variance of randomised quasi-Monte Carlo |
//! | [`planes`] | do two estimated pictures differ? |
//! | [`error`] | by how much do two pictures differ? |
//!
//! All in `f64`, summed in the order given, with the functions of `etendue_core::maths`: the same bits everywhere. This
//! crate does not know what the numbers mean.

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
