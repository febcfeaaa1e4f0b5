//! Fits: parameters from observations, with their covariance.
//!
//! | fit | of | file |
//! | --- | --- | --- |
//! | [`levenberg`] | any residuals, by Levenberg and Marquardt | `levenberg.rs` |
//! | [`Homography`] | plane to plane in perspective | `homography.rs` |
//! | [`PolynomialMap`] | plane to plane, by a polynomial | `polynomial.rs` |

mod homography;
pub mod levenberg;
mod polynomial;

pub use homography::{Homography, null_vector};
pub use levenberg::{Fit, FitError, Problem, fit};
pub use polynomial::{Jet, PolynomialMap};
