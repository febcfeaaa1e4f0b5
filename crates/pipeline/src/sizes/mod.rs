//! Sizes and counts: pure numbers of which plan, rendering and report are made. Nothing here knows a plan.
//!
//! - [`tile`] cuts a frame into tiles and shards, [`block`] a tile into blocks of pixels that share paths.
//! - [`film`] counts the planes of a film and their bytes.
//! - [`spectrum_spread`] tells how evenly wavelengths lie over the bands, [`tolerance`] which errors of a pixel's mean are let be.

pub mod block;
pub mod film;
pub mod spectrum_spread;
pub mod tile;
pub mod tolerance;
