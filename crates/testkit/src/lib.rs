//! Brute-force and conservation oracles for tests.
//!
//! | module | answers |
//! | --- | --- |
//! | [`judge`] | is an estimated picture what a closed form says? |
//! | [`form_factor`] | irradiance from spheres and polygons, and behind a round, perhaps clipped, pupil; integrals by plain sums |
//! | [`page`] | docs/extremes.md: what stands in it, and whether it holds |
//! | [`skip`] | tests whose files are missing, counted |
//!
//! Nothing here shares code with what it judges, but for the vocabulary and the elementary functions of `core`.

pub mod form_factor;
pub mod judge;
pub mod page;
pub mod skip;
