//! What of a camera is stated beforehand.

use crate::Estimate;
use glam::DVec2;

/// What is known before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// fx = fy.
    pub square_pixels: bool,
    /// The principal point is this, raster coordinates; otherwise it is fitted.
    pub principal_px: Option<DVec2>,
    /// The focal length (principal distance) is this, px; otherwise it is fitted.
    pub focal_px: Option<f64>,
    /// The entrance pupil is at this distance from the chart's plane in every view, in the caller's unit of length.
    pub distance: Option<Estimate>,
    /// Points far from the fit count less.
    pub robust: bool,
}
