//! The size of a plot and of what stands about its axes, px.

pub(super) const WIDTH: f64 = 760.0;
pub(super) const HEIGHT: f64 = 460.0;
pub(super) const LEFT: f64 = 84.0;
pub(super) const RIGHT: f64 = 24.0;
pub(super) const TOP: f64 = 44.0;
pub(super) const BOTTOM: f64 = 60.0;
