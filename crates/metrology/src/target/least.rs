//! How many points make a chart.

/// Least points of a grid whose size is not stated.
pub(super) const LEAST: usize = 16;
