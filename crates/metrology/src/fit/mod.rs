//! Fits: parameters from observations, with their covariance.
//!
//! | fit | of | file |
//! | --- | --- | --- |
//! | [`levenberg`] | any residuals, by Levenberg and Marquardt | `levenberg.rs` |
//! | [`Homography`] | plane to plane in perspective | `homography.rs` |
//! | [`shrunken()`] | lines in coefficients, some of which are small | `shrunken.rs` |

mod homography;
pub mod levenberg;
mod shrunken;

pub use homography::{Homography, null_vector};
pub use levenberg::{Fit, FitError, Problem, fit, slopes};
pub use shrunken::{Shrunken, shrunken};
