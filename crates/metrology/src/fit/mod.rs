//! Fits: parameters from observations, with their covariance.
//!
//! | fit | of | file |
//! | --- | --- | --- |
//! | [`levenberg`] | any residuals, by Levenberg and Marquardt | `levenberg.rs` |
//! | [`Homography`] | plane to plane in perspective | `homography.rs` |
//! | [`fit_mixed_model()`] | lines in coefficients, some of which are small | `mixed_model.rs` |

mod homography;
pub mod levenberg;
mod mixed_model;

pub use homography::{Homography, null_vector};
pub use levenberg::{Fit, FitError, Problem, fit, slopes};
pub use mixed_model::{MixedModelFit, fit_mixed_model};
