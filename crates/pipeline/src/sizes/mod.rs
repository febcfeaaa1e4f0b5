//! Sizes and counts: pure numbers used by plan, render and report. Nothing here depends on a plan.
//!
//! - [`tile`] divides a frame into tiles and shards, [`block`] a tile into blocks of pixels that share paths.
//! - [`film`] counts the planes of a film and their bytes.
//! - [`spectrum_spread`] is the distribution of wavelengths over the bands, [`tolerance`] the permitted error of a pixel's mean.

pub mod block;
pub mod film;
pub mod spectrum_spread;
pub mod tile;
pub mod tolerance;
