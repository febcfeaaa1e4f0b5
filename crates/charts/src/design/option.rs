//! Ranges of options that several charts share, and common properties of sheets: bleed, white and black.

use crate::error::ChartError;

/// Size of sheets relative to the camera's view: blur and glare reach beyond it.
pub(super) const BLEED: f64 = 1.15;

/// Reflectance of white paper.
pub(super) const WHITE: f64 = 0.9;

/// Reflectance of black ink.
pub(super) const BLACK: f64 = 0.03;

/// A reflectance between 0 and 1.
pub(super) fn reflectance_option(option: &'static str, value: f64) -> Result<f64, ChartError> {
    let is_valid = (0.0..=1.0).contains(&value);
    is_valid.then_some(value).ok_or_else(|| ChartError::option(option, value, "expected a fraction, 0 … 1"))
}

/// An angle by which edges are rotated, degrees, in radians.
pub(super) fn angle(degrees: f64) -> Result<f64, ChartError> {
    let is_valid = (-45.0..=45.0).contains(&degrees);
    is_valid
        .then_some(degrees.to_radians())
        .ok_or_else(|| ChartError::option("angle_deg", degrees, "expected -45 … 45"))
}

/// True if an edge at an angle to rows or columns can be measured: `measure sfr` expects 2° to 43° to the nearer of both.
pub(super) fn is_measurable(degrees: f64) -> bool {
    let to_axis = (degrees - 90.0 * (degrees / 90.0).round()).abs();
    // Angles of a star's edges are sums of rounded numbers.
    (2.0 - 1e-9..=43.0 + 1e-9).contains(&to_axis)
}

/// A ratio of luminances.
pub(super) fn contrast(ratio: f64) -> Result<f64, ChartError> {
    let is_valid = ratio > 1.0 && ratio <= 1000.0;
    is_valid
        .then_some(ratio)
        .ok_or_else(|| ChartError::option("contrast", ratio, "expected a ratio above 1 and up to 1000"))
}
